// SPDX-License-Identifier: Apache-2.0
#include "scan/las/laz_coder.h"

#include <algorithm>

namespace wellspring::scan {

namespace {
constexpr uint32_t longest_cycle_of_bits = 64;
constexpr uint32_t least_tabled = 17;        // so many symbols and more are found by a table
constexpr uint32_t modelled_value_bits = 8;  // the other bits of a difference have no model
}  // namespace

void SymbolModel::begin() {
  if (symbols_ >= least_tabled) {
    uint32_t table_bits = 3;
    while (symbols_ > 1u << (table_bits + 2)) table_bits++;
    table_size_ = 1u << table_bits;
    table_shift_ = uint32_t(symbol_precision) - table_bits;
  }
  const size_t table_count = table_size_ > 0 ? table_size_ + 2 : 0;
  data_ = std::make_unique<uint16_t[]>(2 * symbols_ + table_count);
  bounds_ = data_.get(), counts_ = bounds_ + symbols_;
  table_ = table_size_ > 0 ? counts_ + symbols_ : nullptr;
  std::fill_n(counts_, symbols_, uint16_t(1));
  cycle_ = symbols_;
  update();
  until_update_ = cycle_ = (symbols_ + 6) / 2;
}

// Computes probabilities from the counts, and how many symbols are read until the next time.
void SymbolModel::update() {
  total_ += cycle_;
  if (total_ > 1u << symbol_precision) {
    total_ = 0;
    for (uint32_t i = 0; i < symbols_; i++) {
      counts_[i] = uint16_t((counts_[i] + 1) / 2);
      total_ += counts_[i];
    }
  }
  const uint32_t scale = (1u << 31) / total_;
  uint32_t sum = 0, slot = 0;
  for (uint32_t i = 0; i < symbols_; i++) {
    bounds_[i] = uint16_t((scale * sum) >> (31 - symbol_precision));
    sum += counts_[i];
    if (!table_) continue;
    for (const uint32_t end = bounds_[i] >> table_shift_; slot < end;)
      table_[++slot] = uint16_t(i - 1);
  }
  if (table_) {
    table_[0] = 0;
    while (slot <= table_size_) table_[++slot] = uint16_t(symbols_ - 1);
  }
  cycle_ = std::min(5 * cycle_ / 4, (symbols_ + 6) * 8);
  until_update_ = cycle_;
}

std::vector<SymbolModel> make_models(size_t count, uint32_t symbols) {
  std::vector<SymbolModel> models;
  models.reserve(count);
  for (size_t i = 0; i < count; i++) models.emplace_back(symbols);
  return models;
}

void BitModel::update() {
  count_ += cycle_;
  if (count_ > 1u << bit_precision) {
    count_ = (count_ + 1) / 2;
    zero_count_ = (zero_count_ + 1) / 2;
    if (zero_count_ == count_) count_++;
  }
  zero_probability_ = (zero_count_ * ((1u << 31) / count_)) >> (31 - bit_precision);
  cycle_ = std::min(5 * cycle_ / 4, longest_cycle_of_bits);
  until_update_ = cycle_;
}

ArithmeticDecoder::ArithmeticDecoder(std::span<const uint8_t> bytes)
    : next_(bytes.data()), end_(bytes.data() + bytes.size()) {
  length_ = 0;
  for (int i = 0; i < 4; i++) {
    value_ <<= 8;
    if (next_ != end_) value_ |= *next_++;
    else is_damaged_ = true;
  }
  length_ = 0xffffffff;
  if (value_ < length_) return;
  is_damaged_ = true;  // a value beyond the interval would leave tables
  value_ = 0;
}

uint32_t ArithmeticDecoder::read_bits(uint32_t bits) {
  if (bits > 19) {
    const uint32_t low = read_bits(16);
    return read_bits(bits - 16) << 16 | low;
  }
  length_ >>= bits;
  const uint32_t read = value_ / length_;
  value_ -= length_ * read;
  if (length_ < coder_least_length) refill();
  if (read < 1u << bits) return read;
  is_damaged_ = true;
  return 0;
}

uint64_t ArithmeticDecoder::read_64_bits() {
  const uint64_t low = read_bits(32);
  return uint64_t(read_bits(32)) << 32 | low;
}

IntegerDecoder::IntegerDecoder(uint32_t bits, uint32_t contexts)
    : bits_(bits), lengths_(make_models(contexts, bits + 1)) {
  values_.reserve(bits);
  for (uint32_t i = 1; i <= bits; i++) values_.emplace_back(1u << std::min(i, modelled_value_bits));
}

int32_t IntegerDecoder::read_difference(ArithmeticDecoder& decoder, uint32_t context) {
  const uint32_t bits = last_bits_ = decoder.read_symbol(lengths_[context]);
  if (bits == 0) return int32_t(decoder.read_bit(sign_));
  if (bits == 32) return INT32_MIN;
  uint32_t value = decoder.read_symbol(values_[bits - 1]);
  if (bits > modelled_value_bits) {
    const uint32_t raw_bits = bits - modelled_value_bits;
    value = value << raw_bits | decoder.read_bits(raw_bits);
  }
  // The interval of k bits leaves out what fewer bits reach: [-(2^k - 1), -2^(k-1)] and
  // [2^(k-1) + 1, 2^k].
  if (value >= 1u << (bits - 1)) return int32_t(value + 1);
  return int32_t(value - ((1u << bits) - 1));
}

}  // namespace wellspring::scan
