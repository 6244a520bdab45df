// SPDX-License-Identifier: Apache-2.0
// Decodes what LASzip's arithmetic coder wrote: symbols of adaptive models, raw bits, and integers
// as their difference from a prediction (Said 2004, "Introduction to Arithmetic Coding";
// Isenburg 2013, "LASzip: lossless compression of LiDAR data", section 3).
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/layers.h"

namespace wellspring::scan {

inline constexpr uint32_t coder_least_length = 1u << 24;  // a shorter interval takes another byte
inline constexpr int symbol_precision = 15, bit_precision = 13;  // bits of a probability

// Adapts to how often each of 2 to 2048 symbols occurs. Takes memory with its first symbol, so that
// models that a chunk does not use cost nothing.
class SymbolModel {
 public:
  explicit SymbolModel(uint32_t symbols) : symbols_(symbols) {}

 private:
  friend class ArithmeticDecoder;
  void begin();
  void update();

  uint32_t symbols_, until_update_ = 0, cycle_ = 0, total_ = 0;
  uint32_t table_size_ = 0, table_shift_ = 0;  // a table finds symbols; 0: they are too few
  std::unique_ptr<uint16_t[]> data_;
  uint16_t *bounds_ = nullptr, *counts_ = nullptr, *table_ = nullptr;
};

// Makes so many models, each of so many symbols.
std::vector<SymbolModel> make_models(size_t count, uint32_t symbols);

// The same of two symbols.
class BitModel {
 private:
  friend class ArithmeticDecoder;
  void update();

  uint32_t zero_count_ = 1, count_ = 2, until_update_ = 4, cycle_ = 4;
  uint32_t zero_probability_ = 1u << (bit_precision - 1);
};

// Reads one stream. Whatever its bytes are, symbols stay in their range; is_damaged() tells that
// they cannot be what was written. Borrows the bytes.
class ArithmeticDecoder {
 public:
  ArithmeticDecoder() = default;
  explicit ArithmeticDecoder(std::span<const uint8_t> bytes);

  uint32_t read_symbol(SymbolModel& model);
  uint32_t read_bit(BitModel& model);
  // Reads 1 to 32 bits that have no model, the low ones first.
  uint32_t read_bits(uint32_t bits);
  uint64_t read_64_bits();

  bool is_damaged() const { return is_damaged_; }
  void set_damaged() { is_damaged_ = true; }

 private:
  void refill();

  uint32_t value_ = 0, length_ = 0xffffffff;  // the value lies in [0, length)
  const uint8_t *next_ = nullptr, *end_ = nullptr;
  bool is_damaged_ = false;
};

// Reads integers of some bits. The number of bits that a difference needs is coded by context, its
// value by that number.
class IntegerDecoder {
 public:
  explicit IntegerDecoder(uint32_t bits, uint32_t contexts = 1);
  int32_t read(ArithmeticDecoder& decoder, int32_t predicted, uint32_t context = 0);
  // Returns how many bits the last difference needed.
  uint32_t last_bits() const { return last_bits_; }

 private:
  int32_t read_difference(ArithmeticDecoder& decoder, uint32_t context);

  uint32_t bits_, last_bits_ = 0;
  std::vector<SymbolModel> lengths_, values_;
  BitModel sign_;
};

inline void ArithmeticDecoder::refill() {
  do {
    uint32_t byte = 0;
    if (next_ != end_) byte = *next_++;
    else is_damaged_ = true;
    value_ = value_ << 8 | byte;
    length_ <<= 8;
  } while (length_ < coder_least_length);
}

inline uint32_t ArithmeticDecoder::read_bit(BitModel& model) {
  const uint32_t bound = model.zero_probability_ * (length_ >> bit_precision);
  const bool is_one = value_ >= bound;
  if (is_one) value_ -= bound, length_ -= bound;
  else length_ = bound, model.zero_count_++;
  if (length_ < coder_least_length) refill();
  if (--model.until_update_ == 0) model.update();
  return is_one;
}

inline uint32_t ArithmeticDecoder::read_symbol(SymbolModel& model) {
  if (!model.data_) model.begin();
  const uint16_t* bounds = model.bounds_;
  const uint32_t unit = length_ >> symbol_precision;
  uint32_t symbol = 0, above = model.symbols_;
  uint32_t low = 0, high = length_;
  if (model.table_) {
    const uint32_t place = value_ / unit, slot = place >> model.table_shift_;
    symbol = model.table_[slot], above = model.table_[slot + 1] + 1u;
    while (above > symbol + 1) {
      const uint32_t middle = (symbol + above) / 2;
      if (bounds[middle] > place) above = middle;
      else symbol = middle;
    }
    low = bounds[symbol] * unit;
    if (symbol + 1 < model.symbols_) high = bounds[symbol + 1] * unit;
  } else {
    while (above > symbol + 1) {
      const uint32_t middle = (symbol + above) / 2, bound = bounds[middle] * unit;
      if (bound > value_) above = middle, high = bound;
      else symbol = middle, low = bound;
    }
  }
  value_ -= low;
  length_ = high - low;
  if (length_ < coder_least_length) refill();
  model.counts_[symbol]++;
  if (--model.until_update_ == 0) model.update();
  return symbol;
}

inline int32_t IntegerDecoder::read(ArithmeticDecoder& decoder, int32_t predicted,
                                    uint32_t context) {
  const uint32_t read = uint32_t(predicted) + uint32_t(read_difference(decoder, context));
  if (bits_ == 32) return int32_t(read);
  const uint32_t range = 1u << bits_;
  if (int32_t(read) < 0) return int32_t(read + range);
  return int32_t(read >= range ? read - range : read);
}

}  // namespace wellspring::scan
