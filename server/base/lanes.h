// SPDX-License-Identifier: Apache-2.0
// Eight floats side by side, as vector units compute them; arithmetic and comparisons are the
// compiler's (GCC and Clang vector extensions), `mask ? a : b` chooses lane by lane.
#pragma once
#include <cmath>
#ifdef __AVX__
#include <immintrin.h>
#endif

namespace wellspring {

inline constexpr int lane_count = 8;
using Lanes = float __attribute__((vector_size(4 * lane_count)));
using LaneMask = int __attribute__((vector_size(4 * lane_count)));

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
inline float lanes_sum(Lanes a) {
  return ((a[0] + a[1]) + (a[2] + a[3])) + ((a[4] + a[5]) + (a[6] + a[7]));
}

}  // namespace wellspring
