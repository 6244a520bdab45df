// SPDX-License-Identifier: Apache-2.0
// Normals in two bytes, as NodePoints has them (Meyer et al. 2010, "On floating-point normal
// vectors").
#pragma once
#include <cmath>
#include <cstdint>

#include "base/vec.h"

namespace wellspring::scan {

inline constexpr uint16_t no_normal = 0x8080;

// Returns the code of a direction of any length; 0 and what is not finite have no_normal.
inline uint16_t encode_octahedral(vec3 n) {
  const float sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
  if (!(sum > 0) || !std::isfinite(sum)) return no_normal;
  float u = n.x / sum, v = n.y / sum;
  if (n.z < 0) {
    const float folded = (1 - std::abs(v)) * (u < 0 ? -1.0f : 1.0f);
    v = (1 - std::abs(u)) * (v < 0 ? -1.0f : 1.0f), u = folded;
  }
  const auto code = [](float a) { return uint16_t(uint8_t(int8_t(std::lround(a * 127)))); };
  return uint16_t(code(u) | code(v) << 8);
}

// Returns the unit direction; 0 for no_normal.
inline vec3 decode_octahedral(uint16_t code) {
  if (code == no_normal) return vec3(0);
  const float u = float(int8_t(code & 255)) / 127, v = float(int8_t(code >> 8)) / 127;
  vec3 n(u, v, 1 - std::abs(u) - std::abs(v));
  if (n.z < 0) {
    n.x = (1 - std::abs(v)) * (u < 0 ? -1.0f : 1.0f);
    n.y = (1 - std::abs(u)) * (v < 0 ? -1.0f : 1.0f);
  }
  return glm::normalize(n);
}

}  // namespace wellspring::scan
