// SPDX-License-Identifier: Apache-2.0
// Eight floats side by side, as vector units compute them; arithmetic and comparisons are the
// compiler's (GCC and Clang vector extensions), `mask ? a : b` chooses lane by lane.
#pragma once
#include <cmath>
#include <cstdint>
#include <cstring>
#ifdef __AVX__
#include <immintrin.h>
#endif

namespace wellspring {

inline constexpr int lane_count = 8;
using Lanes = float __attribute__((vector_size(4 * lane_count)));
using LaneMask = int __attribute__((vector_size(4 * lane_count)));
using LaneBits = uint32_t __attribute__((vector_size(4 * lane_count)));

inline Lanes all_lanes(float x) { return Lanes{x, x, x, x, x, x, x, x}; }
inline Lanes lanes_max(Lanes a, Lanes b) { return a > b ? a : b; }
inline Lanes lanes_min(Lanes a, Lanes b) { return a < b ? a : b; }
inline Lanes lanes_abs(Lanes a) { return a < 0 ? -a : a; }
inline Lanes lanes_sqrt(Lanes a) {
#ifdef __AVX__
  return Lanes(_mm256_sqrt_ps(__m256(a)));
#else
  for (int i = 0; i < lane_count; i++) a[i] = std::sqrt(a[i]);
  return a;
#endif
}
// Eight neighbours in memory, aligned or not.
inline Lanes load_lanes(const float* from) {
  Lanes a;
  std::memcpy(&a, from, sizeof a);
  return a;
}
inline void store_lanes(float* to, Lanes a) { std::memcpy(to, &a, sizeof a); }
inline void store_lanes(int32_t* to, LaneMask a) { std::memcpy(to, &a, sizeof a); }
// Eight rows become eight columns.
inline void transpose_lanes(Lanes (&row)[lane_count]) {
  Lanes pair[lane_count], four[lane_count];
  for (int i = 0; i < lane_count; i += 2) {
    pair[i] = __builtin_shufflevector(row[i], row[i + 1], 0, 8, 1, 9, 4, 12, 5, 13);
    pair[i + 1] = __builtin_shufflevector(row[i], row[i + 1], 2, 10, 3, 11, 6, 14, 7, 15);
  }
  for (int i = 0; i < lane_count; i += 4)
    for (int k = 0; k < 2; k++) {
      Lanes a = pair[i + k], b = pair[i + k + 2];
      four[i + 2 * k] = __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13);
      four[i + 2 * k + 1] = __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15);
    }
  for (int i = 0; i < 4; i++) {
    row[i] = __builtin_shufflevector(four[i], four[i + 4], 0, 1, 2, 3, 8, 9, 10, 11);
    row[i + 4] = __builtin_shufflevector(four[i], four[i + 4], 4, 5, 6, 7, 12, 13, 14, 15);
  }
}
// To the nearest whole number, as std::lrint does.
inline LaneMask round_lanes(Lanes a) {
#ifdef __AVX__
  return LaneMask(_mm256_cvtps_epi32(__m256(a)));
#else
  LaneMask whole;
  for (int i = 0; i < lane_count; i++) whole[i] = int(std::lrint(a[i]));
  return whole;
#endif
}
// Bit i: lane i is negative, so set in a comparison's answer.
inline unsigned negative_lanes(LaneMask a) {
#ifdef __AVX__
  return unsigned(_mm256_movemask_ps(__m256(a)));
#else
  unsigned bits = 0;
  for (int i = 0; i < lane_count; i++) bits |= unsigned(a[i] < 0) << i;
  return bits;
#endif
}
// The comparison's answer that has these bits.
inline LaneMask lanes_of_bits(unsigned bits) {
  constexpr LaneMask bit{1, 2, 4, 8, 16, 32, 64, 128};
  return ((LaneMask{} + int(bits)) & bit) != 0;
}
inline float lanes_sum(Lanes a) {
  return ((a[0] + a[1]) + (a[2] + a[3])) + ((a[4] + a[5]) + (a[6] + a[7]));
}

}  // namespace wellspring
