// SPDX-License-Identifier: Apache-2.0
// What cache/packing.h packs and unpacks, of eight points at a time.
#pragma once
#include "base/rgb9e5_simd.h"
#include "base/simd.h"

namespace wellspring::cache {

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
// Packing likewise, of what is finite.
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
inline Lanes luminance(const Lanes& r, const Lanes& g, const Lanes& b) {
  return 0.2126f * r + 0.7152f * g + 0.0722f * b;
}

}  // namespace wellspring::cache
