// SPDX-License-Identifier: Apache-2.0
// Unit vectors on an octahedron (Meyer et al. 2010), 16 bits an axis: within a hundredth of a
// degree. Ageing compares dot products, for which the 8 bits of cache/packing.h are too few where
// objects turn and their normals are packed again and again.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/simd.h"

namespace wellspring::test {

// Packs a vector of any length but 0.
inline uint32_t pack_fine_normal(vec3 n) {
  float sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
  float x = n.x / sum, y = n.y / sum;
  if (n.z < 0) {
    float fx = (1 - std::abs(y)) * (x >= 0 ? 1.0f : -1.0f);
    y = (1 - std::abs(x)) * (y >= 0 ? 1.0f : -1.0f);
    x = fx;
  }
  auto level = [](float v) { return uint32_t(std::clamp(v * 32767 + 32767.5f, 0.0f, 65534.0f)); };
  return level(x) | level(y) << 16;
}
inline Lanes3 unpack_fine_normal(const LaneBits& p) {
  Lanes x = to_float(p & 65535u) * (1.0f / 32767) - 1.0f;
  Lanes y = to_float(p >> 16) * (1.0f / 32767) - 1.0f;
  Lanes z = 1.0f - lanes_abs(x) - lanes_abs(y);
  Lanes fold = positive_lanes(-z);
  x += x >= 0.0f ? -fold : fold;
  y += y >= 0.0f ? -fold : fold;
  Lanes scale = 1.0f / lanes_sqrt(x * x + y * y + z * z);
  return {x * scale, y * scale, z * scale};
}

}  // namespace wellspring::test
