// SPDX-License-Identifier: Apache-2.0
// Eight pixels (or cells) at a time, written once for every processor: vector types of GCC and
// Clang. Comparisons give lanes of all bits or none; `mask ? a : b` chooses lane by lane.
#pragma once
#include <cstdint>
#include <cstring>

#include "base/simd.h"

namespace wellspring {

inline constexpr int lanes = 8;
using f8 = float __attribute__((vector_size(32)));
using i8 = int32_t __attribute__((vector_size(32)));
using u8 = uint32_t __attribute__((vector_size(32)));
using f4 = float __attribute__((vector_size(16)));
using u4 = uint32_t __attribute__((vector_size(16)));

// From and to memory of any alignment.
template <class V, class T>
inline V load(const T* from) {
  V v;
  std::memcpy(&v, from, sizeof v);
  return v;
}
template <class V, class T>
inline void store(T* to, const V& v) {
  std::memcpy(to, &v, sizeof v);
}
inline f8 splat(float v) { return f8{} + v; }
// The same bits in other lanes of the same size.
template <class To, class From>
inline To as(const From& v) {
  return reinterpret_cast<To>(v);
}
inline f8 to_float(const u8& v) { return __builtin_convertvector(as<i8>(v), f8); }
inline f8 keep(const i8& mask, const f8& v) { return as<f8>(as<i8>(v) & mask); }
inline f8 larger(const f8& a, const f8& b) { return a > b ? a : b; }
inline f8 smaller(const f8& a, const f8& b) { return a < b ? a : b; }
inline f8 positive(const f8& v) { return larger(v, f8{}); }
inline f8 magnitude(const f8& v) { return as<f8>(as<u8>(v) & 0x7fffffffu); }
template <class V>
inline bool any(const V& v) {
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

// Two halves side by side.
inline u8 join(const u4& low, const u4& high) {
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}
inline u4 low_half(const u8& v) { return __builtin_shufflevector(v, v, 0, 1, 2, 3); }
inline u4 high_half(const u8& v) { return __builtin_shufflevector(v, v, 4, 5, 6, 7); }

// Eight records of four words each, `record(0)` to `record(7)`, become four times eight lanes.
template <class Record>
inline void transpose(const Record& record, u8& a, u8& b, u8& c, u8& d) {
  auto pair = [&](int i) { return join(load<u4>(record(i)), load<u4>(record(i + 4))); };
  u8 r04 = pair(0), r15 = pair(1), r26 = pair(2), r37 = pair(3);
  u8 ab01 = __builtin_shufflevector(r04, r15, 0, 8, 1, 9, 4, 12, 5, 13),
     cd01 = __builtin_shufflevector(r04, r15, 2, 10, 3, 11, 6, 14, 7, 15),
     ab23 = __builtin_shufflevector(r26, r37, 0, 8, 1, 9, 4, 12, 5, 13),
     cd23 = __builtin_shufflevector(r26, r37, 2, 10, 3, 11, 6, 14, 7, 15);
  a = __builtin_shufflevector(ab01, ab23, 0, 1, 8, 9, 4, 5, 12, 13);
  b = __builtin_shufflevector(ab01, ab23, 2, 3, 10, 11, 6, 7, 14, 15);
  c = __builtin_shufflevector(cd01, cd23, 0, 1, 8, 9, 4, 5, 12, 13);
  d = __builtin_shufflevector(cd01, cd23, 2, 3, 10, 11, 6, 7, 14, 15);
}

// Unpacking as in cache/packing.h.
inline void unpack_rgb9e5(const u8& p, f8& r, f8& g, f8& b) {
  f8 unit = as<f8>(((p >> 27) + (127 - 24)) << 23);
  r = to_float(p & 511u) * unit;
  g = to_float((p >> 9) & 511u) * unit;
  b = to_float((p >> 18) & 511u) * unit;
}
inline void unpack_albedo(const u8& p, f8& r, f8& g, f8& b) {
  r = to_float(p & 2047u) * (1.0f / 2047);
  g = to_float((p >> 11) & 2047u) * (1.0f / 2047);
  b = to_float(p >> 22) * (1.0f / 1023);
  r *= r, g *= g, b *= b;
}
inline void unpack_octahedron(const u8& p, f8& x, f8& y, f8& z) {
  x = to_float(p & 255u) * (1.0f / 127) - 1.0f;
  y = to_float((p >> 8) & 255u) * (1.0f / 127) - 1.0f;
  z = 1.0f - magnitude(x) - magnitude(y);
  f8 fold = positive(-z);
  x += x >= 0.0f ? -fold : fold;
  y += y >= 0.0f ? -fold : fold;
}
inline f8 unpack_deviation(const u8& p) {
  return keep(p != 0u, as<f8>((p + ((127 - 11) << 4)) << 19));
}
// Packing likewise, of what is finite.
inline u8 to_whole(const f8& v) { return as<u8>(__builtin_convertvector(v, i8)); }
inline u8 pack_albedo(const f8& r, const f8& g, const f8& b) {
  auto level = [](const f8& v, float steps) {
    return to_whole(lanes_sqrt(smaller(positive(v), splat(1))) * steps + 0.5f);
  };
  return level(r, 2047) | level(g, 2047) << 11 | level(b, 1023) << 22;
}
inline u8 pack_normal(const f8& nx, const f8& ny, const f8& nz) {
  f8 share = 1.0f / larger(magnitude(nx) + magnitude(ny) + magnitude(nz), splat(1e-30f));
  f8 x = nx * share, y = ny * share;
  f8 fx = 1.0f - magnitude(y), fy = 1.0f - magnitude(x);
  i8 below = nz < 0.0f;
  f8 ox = below ? (x >= 0.0f ? fx : -fx) : x, oy = below ? (y >= 0.0f ? fy : -fy) : y;
  auto level = [](const f8& v) {
    return to_whole(smaller(larger(v * 127.0f + 127.5f, f8{}), splat(254)));
  };
  return level(ox) | level(oy) << 8;
}
inline f8 luminance(const f8& r, const f8& g, const f8& b) {
  return 0.2126f * r + 0.7152f * g + 0.0722f * b;
}

}  // namespace wellspring
