// SPDX-License-Identifier: Apache-2.0
// Packs colours and normals in few bits, so that a visitor's whole cache stays below 64 MB at
// 1280x720. Light is stored with a shared exponent and rounded stochastically: a running mean of
// many samples then stays unbiased although each step is smaller than the least bit.
#pragma once
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "base/rgb9e5.h"
#include "base/simd.h"
#include "base/vec.h"

namespace wellspring::cache {

// Packs a reflectance in [0, 1] as 11:11:10 bits of its square root.
inline uint32_t pack_albedo(vec3 c) {
  auto level = [](float v, float steps) {
    float root = std::sqrt(v > 0 ? std::min(v, 1.0f) : 0.0f);
    return uint32_t(root * steps + 0.5f);
  };
  return level(c.x, 2047) | level(c.y, 2047) << 11 | level(c.z, 1023) << 22;
}
inline vec3 unpack_albedo(uint32_t p) {
  float r = float(p & 2047) * (1.0f / 2047), g = float((p >> 11) & 2047) * (1.0f / 2047),
        b = float(p >> 22) * (1.0f / 1023);
  return vec3(r * r, g * g, b * b);
}

// Packs a unit vector on an octahedron (Meyer et al. 2010) with 8 bits an axis, within one degree.
inline uint16_t pack_normal(vec3 n) {
  float sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
  if (!(sum > 0) || !std::isfinite(sum)) return 127 | 127 << 8;
  float x = n.x / sum, y = n.y / sum;
  if (n.z < 0) {
    float fx = (1 - std::abs(y)) * (x >= 0 ? 1.0f : -1.0f);
    y = (1 - std::abs(x)) * (y >= 0 ? 1.0f : -1.0f);
    x = fx;
  }
  auto level = [](float v) { return uint16_t(std::clamp(v * 127.0f + 127.5f, 0.0f, 254.0f)); };
  return uint16_t(level(x) | level(y) << 8);
}
// Returns the point on the octahedron, not normalised (length 0.57 to 1): enough for signs of dot
// products.
inline vec3 unpack_octahedron(uint16_t p) {
  float x = float(p & 255) * (1.0f / 127) - 1, y = float(p >> 8) * (1.0f / 127) - 1;
  float z = 1 - std::abs(x) - std::abs(y);
  float t = z < 0 ? -z : 0.0f;
  x += x >= 0 ? -t : t;
  y += y >= 0 ? -t : t;
  return vec3(x, y, z);
}
inline vec3 unpack_normal(uint16_t p) {
  vec3 n = unpack_octahedron(p);
  return n * (1 / std::sqrt(dot(n, n)));
}

// Packs a standard deviation with 4 bits of exponent and 4 of mantissa, steps of 3 to 6 %: 2^-11 to
// 2^5; 0 is exactly 0. The result is the rounded top of the number's own bits, so both ways take a
// few instructions. `random`: as for pack_rgb9e5(), 19 bits count; the default rounds to the
// nearest.
inline uint8_t pack_deviation(float s, uint32_t random = 1u << 18) {
  constexpr int least = (127 - 11) << 4;
  if (!(s > 0x1p-12f)) return 0;
  int bits = int((std::bit_cast<uint32_t>(std::min(s, 31.0f)) + (random & ((1u << 19) - 1))) >> 19);
  return uint8_t(std::clamp(bits - least, 1, 255));
}
inline float unpack_deviation(uint8_t p) {
  constexpr uint32_t least = (127 - 11) << 4;
  return p ? std::bit_cast<float>((uint32_t(p) + least) << 19) : 0.0f;
}

// Packs a standard deviation over its mean with 6 bits: 2^-5 to 2^5 in steps of 12 %; 0 is unknown
// or next to nothing. `random`: in [0, 65536), dithers the bits that are cut.
inline uint8_t pack_relative(float s, uint32_t random = 0x8000) {
  if (!(s > 0x1p-5f)) return 0;
  float step =
      std::log2(std::min(s, 32.0f)) * 6 + 31.5f + (float(random & 0xffff) * 0x1p-16f - 0.5f);
  return uint8_t(std::clamp(int(step + 0.5f), 1, 63));
}
inline float unpack_relative(uint8_t p) { return p ? std::exp2((float(p) - 31.5f) / 6) : 0.0f; }

// Packs a positive number as an IEEE half float; `random` in [0, 65536) dithers the bits that are
// cut.
inline uint16_t pack_half(float v, uint32_t random = 0x1000) {
  v = v > 0 ? std::min(v, 65000.0f) : 0.0f;
  uint32_t bits = std::bit_cast<uint32_t>(v * 0x1p-112f) + (random & 0x1fff);
  return uint16_t(bits >> 13);
}
inline float unpack_half(uint16_t h) { return std::bit_cast<float>(uint32_t(h) << 13) * 0x1p112f; }

// Packs and unpacks as cache/packing.h does, for eight points at a time.

inline void unpack_albedo(const LaneBits& p, Lanes& r, Lanes& g, Lanes& b) {
  r = to_float(p & 2047u) * (1.0f / 2047);
  g = to_float((p >> 11) & 2047u) * (1.0f / 2047);
  b = to_float(p >> 22) * (1.0f / 1023);
  r *= r, g *= g, b *= b;
}
inline void unpack_octahedron(const LaneBits& p, Lanes& x, Lanes& y, Lanes& z) {
  x = to_float(p & 255u) * (1.0f / 127) - 1.0f;
  y = to_float((p >> 8) & 255u) * (1.0f / 127) - 1.0f;
  z = 1.0f - lanes_abs(x) - lanes_abs(y);
  Lanes fold = positive_lanes(-z);
  x += x >= 0.0f ? -fold : fold;
  y += y >= 0.0f ? -fold : fold;
}
inline Lanes unpack_deviation(const LaneBits& p) {
  return keep_lanes(p != 0u, lanes_as<Lanes>((p + ((127 - 11) << 4)) << 19));
}
// Packs likewise; values have to be finite.
inline LaneBits pack_albedo(const Lanes& r, const Lanes& g, const Lanes& b) {
  auto level = [](const Lanes& v, float steps) {
    return to_whole(lanes_sqrt(lanes_min(positive_lanes(v), all_lanes(1))) * steps + 0.5f);
  };
  return level(r, 2047) | level(g, 2047) << 11 | level(b, 1023) << 22;
}
inline LaneBits pack_normal(const Lanes& nx, const Lanes& ny, const Lanes& nz) {
  Lanes share = 1.0f / lanes_max(lanes_abs(nx) + lanes_abs(ny) + lanes_abs(nz), all_lanes(1e-30f));
  Lanes x = nx * share, y = ny * share;
  Lanes fx = 1.0f - lanes_abs(y), fy = 1.0f - lanes_abs(x);
  LaneMask below = nz < 0.0f;
  Lanes ox = below ? (x >= 0.0f ? fx : -fx) : x, oy = below ? (y >= 0.0f ? fy : -fy) : y;
  auto level = [](const Lanes& v) {
    return to_whole(lanes_min(lanes_max(v * 127.0f + 127.5f, Lanes{}), all_lanes(254)));
  };
  return level(ox) | level(oy) << 8;
}
using wellspring::luminance;
inline Lanes luminance(const Lanes& r, const Lanes& g, const Lanes& b) {
  return 0.2126f * r + 0.7152f * g + 0.0722f * b;
}

}  // namespace wellspring::cache
