// SPDX-License-Identifier: Apache-2.0
// Computes eight numbers side by side, as vector units do, written once for every processor:
// arithmetic and comparisons are the compiler's (GCC and Clang vector extensions). Comparisons give
// lanes of all bits or none; `mask ? a : b` chooses lane by lane.
#pragma once
#include <cmath>
#include <cstdint>
#include <cstring>

#include "base/vec.h"

#ifdef __AVX__
#include <immintrin.h>

#include "base/layers.h"
#endif

namespace wellspring {

inline constexpr int lane_count = 8;
using Lanes = float __attribute__((vector_size(4 * lane_count)));
using LaneMask = int32_t __attribute__((vector_size(4 * lane_count)));  // whole numbers, too
using LaneBits = uint32_t __attribute__((vector_size(4 * lane_count)));
using HalfLanes = float __attribute__((vector_size(2 * lane_count)));
using HalfLaneBits = uint32_t __attribute__((vector_size(2 * lane_count)));

inline Lanes all_lanes(float x) { return Lanes{x, x, x, x, x, x, x, x}; }
inline LaneBits all_lane_bits(uint32_t x) { return LaneBits{x, x, x, x, x, x, x, x}; }
inline Lanes lanes_max(Lanes a, Lanes b) { return a > b ? a : b; }
inline Lanes lanes_min(Lanes a, Lanes b) { return a < b ? a : b; }
// Returns the same bits as other lanes of the same size.
template <class To, class From>
inline To lanes_as(const From& v) {
  static_assert(sizeof(To) == sizeof(From));
  return reinterpret_cast<To>(v);
}
inline Lanes lanes_abs(Lanes a) { return lanes_as<Lanes>(lanes_as<LaneBits>(a) & 0x7fffffffu); }
inline Lanes positive_lanes(Lanes a) { return lanes_max(a, Lanes{}); }
// Returns `a`, 0 in lanes in which the mask has no bits.
inline Lanes keep_lanes(LaneMask mask, Lanes a) {
  return lanes_as<Lanes>(lanes_as<LaneMask>(a) & mask);
}
inline Lanes lanes_sqrt(Lanes a) {
#ifdef __AVX__
  return Lanes(_mm256_sqrt_ps(__m256(a)));
#else
  for (int i = 0; i < lane_count; i++) a[i] = std::sqrt(a[i]);
  return a;
#endif
}
// Loads neighbours in memory, aligned or not.
template <class V = Lanes, class T>
inline V load_lanes(const T* from) {
  V v;
  std::memcpy(&v, from, sizeof v);
  return v;
}
template <class T, class V>
inline void store_lanes(T* to, const V& v) {
  std::memcpy(to, &v, sizeof v);
}
// Puts two halves side by side.
inline LaneBits join_halves(HalfLaneBits low, HalfLaneBits high) {
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}
inline HalfLaneBits low_half(LaneBits a) { return __builtin_shufflevector(a, a, 0, 1, 2, 3); }
inline HalfLaneBits high_half(LaneBits a) { return __builtin_shufflevector(a, a, 4, 5, 6, 7); }
// Turns eight rows into eight columns.
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
// Turns eight records of four words each, `record(0)` to `record(7)`, into four times eight lanes.
template <class Record>
inline void transpose_records(const Record& record, LaneBits& a, LaneBits& b, LaneBits& c,
                              LaneBits& d) {
  auto pair = [&](int i) {
    return join_halves(load_lanes<HalfLaneBits>(record(i)),
                       load_lanes<HalfLaneBits>(record(i + 4)));
  };
  LaneBits r04 = pair(0), r15 = pair(1), r26 = pair(2), r37 = pair(3);
  LaneBits ab01 = __builtin_shufflevector(r04, r15, 0, 8, 1, 9, 4, 12, 5, 13),
           cd01 = __builtin_shufflevector(r04, r15, 2, 10, 3, 11, 6, 14, 7, 15),
           ab23 = __builtin_shufflevector(r26, r37, 0, 8, 1, 9, 4, 12, 5, 13),
           cd23 = __builtin_shufflevector(r26, r37, 2, 10, 3, 11, 6, 14, 7, 15);
  a = __builtin_shufflevector(ab01, ab23, 0, 1, 8, 9, 4, 5, 12, 13);
  b = __builtin_shufflevector(ab01, ab23, 2, 3, 10, 11, 6, 7, 14, 15);
  c = __builtin_shufflevector(cd01, cd23, 0, 1, 8, 9, 4, 5, 12, 13);
  d = __builtin_shufflevector(cd01, cd23, 2, 3, 10, 11, 6, 7, 14, 15);
}
inline Lanes to_float(LaneBits a) { return __builtin_convertvector(lanes_as<LaneMask>(a), Lanes); }
// Cuts off towards 0.
inline LaneBits to_whole(Lanes a) {
  return lanes_as<LaneBits>(__builtin_convertvector(a, LaneMask));
}
// Rounds to the nearest whole number, as std::lrint does.
inline LaneMask round_lanes(Lanes a) {
#ifdef __AVX__
  return LaneMask(_mm256_cvtps_epi32(__m256(a)));
#else
  LaneMask whole;
  for (int i = 0; i < lane_count; i++) whole[i] = int(std::lrint(a[i]));
  return whole;
#endif
}
// Returns the lanes that are negative, lane i as bit i; lanes of a comparison that holds are
// negative.
inline unsigned negative_lanes(LaneMask a) {
#ifdef __AVX__
  return unsigned(_mm256_movemask_ps(__m256(a)));
#else
  unsigned bits = 0;
  for (int i = 0; i < lane_count; i++) bits |= unsigned(a[i] < 0) << i;
  return bits;
#endif
}
// Returns whether any bit is set.
template <class V>
inline bool any_lane(const V& v) {
  static_assert(sizeof v == 32);
#ifdef __AVX__
  return !_mm256_testz_si256(__m256i(v), __m256i(v));
#else
  uint64_t words[sizeof v / 8], sum = 0;
  std::memcpy(words, &v, sizeof v);
  for (uint64_t w : words) sum |= w;
  return sum != 0;
#endif
}
// Returns the comparison's answer that has these bits.
inline LaneMask lanes_of_bits(unsigned bits) {
  constexpr LaneMask bit{1, 2, 4, 8, 16, 32, 64, 128};
  return ((LaneMask{} + int(bits)) & bit) != 0;
}
inline float lanes_sum(Lanes a) {
  return ((a[0] + a[1]) + (a[2] + a[3])) + ((a[4] + a[5]) + (a[6] + a[7]));
}

// Computes eight vectors of three side by side.

struct Lanes3 {
  Lanes x{}, y{}, z{};
  vec3 at(int lane) const { return {x[lane], y[lane], z[lane]}; }
  void set(int lane, vec3 v) { x[lane] = v.x, y[lane] = v.y, z[lane] = v.z; }
};
inline Lanes3 all_lanes(vec3 v) { return {all_lanes(v.x), all_lanes(v.y), all_lanes(v.z)}; }
inline Lanes3 operator+(Lanes3 a, Lanes3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Lanes3 operator-(Lanes3 a, Lanes3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Lanes3 operator-(Lanes3 a) { return {-a.x, -a.y, -a.z}; }
inline Lanes3 operator*(Lanes3 a, Lanes3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline Lanes3 operator*(Lanes3 a, Lanes b) { return {a.x * b, a.y * b, a.z * b}; }
inline Lanes dot(Lanes3 a, Lanes3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Lanes max_component(Lanes3 a) { return lanes_max(a.x, lanes_max(a.y, a.z)); }
inline Lanes3 choose(LaneMask mask, Lanes3 a, Lanes3 b) {
  return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}

}  // namespace wellspring
