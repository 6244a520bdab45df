// SPDX-License-Identifier: Apache-2.0
// Loads two neighbours along x at eight places, by one load for each place.
#pragma once
#include <cstring>

#include "base/simd.h"

#ifdef __AVX2__
#include <immintrin.h>
#endif

namespace wellspring::volume {

// Reads words at the places and those after them.
inline void load_word_pairs(const void* from, const LaneMask& index, LaneBits& near,
                            LaneBits& far) {
#ifdef __AVX2__
  auto pairs = [&](const HalfLaneBits& at) {
    return LaneBits(_mm256_i32gather_epi64(static_cast<const long long*>(from), __m128i(at), 4));
  };
  // In this order, the pairs of both loads are parted within halves of vectors, which is cheap.
  const LaneMask order = __builtin_shufflevector(index, index, 0, 1, 4, 5, 2, 3, 6, 7);
  const LaneBits bits = lanes_as<LaneBits>(order);
  const LaneBits low = pairs(low_half(bits)), high = pairs(high_half(bits));
  near = __builtin_shufflevector(low, high, 0, 2, 8, 10, 4, 6, 12, 14);
  far = __builtin_shufflevector(low, high, 1, 3, 9, 11, 5, 7, 13, 15);
#else
  for (int i = 0; i < lane_count; i++) {
    uint32_t pair[2];
    std::memcpy(pair, static_cast<const char*>(from) + ptrdiff_t(index[i]) * 4, sizeof pair);
    near[i] = pair[0], far[i] = pair[1];
  }
#endif
}

// Reads words that begin at multiples of `step` bytes.
template <int step>
inline LaneBits load_words(const void* from, const LaneMask& index) {
#ifdef __AVX2__
  return LaneBits(_mm256_i32gather_epi32(static_cast<const int*>(from), __m256i(index), step));
#else
  LaneBits words;
  for (int i = 0; i < lane_count; i++) {
    uint32_t word;
    std::memcpy(&word, static_cast<const char*>(from) + ptrdiff_t(index[i]) * step, sizeof word);
    words[i] = word;
  }
  return words;
#endif
}

// Read samples at the places and those after them, which are among `count` samples, four at least.
inline void load_pairs(const float* from, int count, const LaneMask& index, Lanes& near,
                       Lanes& far) {
  LaneBits a, b;
  load_word_pairs(from, index, a, b);
  near = lanes_as<Lanes>(a), far = lanes_as<Lanes>(b);
}
inline void load_pairs(const uint16_t* from, int count, const LaneMask& index, Lanes& near,
                       Lanes& far) {
  const LaneBits words = load_words<2>(from, index);
  near = to_float(words & 0xffffu), far = to_float(words >> 16);
}
inline void load_pairs(const uint8_t* from, int count, const LaneMask& index, Lanes& near,
                       Lanes& far) {
  const LaneMask last = LaneMask{} + (count - 4);  // no byte after the samples is read
  const LaneMask at = index < last ? index : last;
  const LaneBits words = load_words<1>(from, at) >> (lanes_as<LaneBits>(index - at) * 8u);
  near = to_float(words & 0xffu), far = to_float(words >> 8 & 0xffu);
}

}  // namespace wellspring::volume
