// SPDX-License-Identifier: Apache-2.0
// Decodes the parts of a point that LASzip codes alike in chunks that go point by point and in
// those that lie in layers: differences of places, time, colour, wave packets.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "scan/las/laz_coder.h"

namespace wellspring::scan {

// Values that a record holds, which are changed by differences and wrap around.
inline int32_t add_wrapped(int32_t a, int32_t b) { return int32_t(uint32_t(a) + uint32_t(b)); }

// Keeps five numbers in order; their median predicts the next one. A new number replaces the
// largest and the smallest in turn.
class RunningMedian {
 public:
  int32_t value() const { return values_[2]; }
  void add(int32_t value);

 private:
  std::array<int32_t, 5> values_{};
  bool replaces_largest_ = true;
};

// Decodes the differences of x and y, whose medians are kept by the kind of return, and z, which is
// predicted from the last one of its kind.
class PlaceDecoder {
 public:
  int32_t read_dx(ArithmeticDecoder& decoder, RunningMedian& median, bool is_single);
  int32_t read_dy(ArithmeticDecoder& decoder, RunningMedian& median, bool is_single);
  int32_t read_z(ArithmeticDecoder& decoder, int32_t predicted, bool is_single);

 private:
  IntegerDecoder dx_{32, 2}, dy_{32, 22}, z_{32, 20};
};

// Decodes the bits of GPS times (version 2 and later): up to four sequences of times, each of which
// goes on by multiples of its last step.
class TimeDecoder {
 public:
  // Layers code no times that stay the same: `knows_same` is false for them.
  TimeDecoder(uint64_t first, bool knows_same);
  uint64_t read(ArithmeticDecoder& decoder);

 private:
  enum class Kind : uint8_t { same, step, far, another };
  struct Sequence {
    uint64_t time = 0;
    int32_t step = 0, extremes = 0;
  };
  void read_far(ArithmeticDecoder& decoder);
  // Each reads one code; true: the time is complete.
  bool read_without_step(ArithmeticDecoder& decoder);
  bool read_with_step(ArithmeticDecoder& decoder);
  int32_t read_multiple(ArithmeticDecoder& decoder, int32_t multiple);

  bool knows_same_;
  SymbolModel multiples_, beginnings_;
  IntegerDecoder differences_{32, 9};
  std::array<Sequence, 4> sequences_;
  uint32_t current_ = 0, newest_ = 0;
};

using LazColor = std::array<uint16_t, 3>;

// Decodes 16 bits each of red, green and blue, byte by byte (version 2 and later).
class ColorDecoder {
 public:
  LazColor read(ArithmeticDecoder& decoder, const LazColor& last);

 private:
  SymbolModel changes_{128};
  std::vector<SymbolModel> bytes_ = make_models(6, 256);
};

inline constexpr int wave_bytes = 29;

// Decodes where the wave of a pulse lies, and the point on it.
class WaveDecoder {
 public:
  // `last` and `wave` have wave_bytes bytes and may be the same.
  void read(ArithmeticDecoder& decoder, const uint8_t* last, uint8_t* wave);

 private:
  SymbolModel index_{256};
  std::vector<SymbolModel> offsets_ = make_models(4, 4);
  IntegerDecoder offset_step_{32}, size_{32}, return_point_{32}, direction_{32, 3};
  uint32_t last_kind_ = 0;
  int32_t last_step_ = 0;
};

}  // namespace wellspring::scan
