// SPDX-License-Identifier: Apache-2.0
// Cells of space and of a surface's main direction, by which light at places is remembered (Binder,
// Fricke, Keller 2019, "Massively Parallel Path Space Filtering", section 3).
#pragma once
#include <cmath>
#include <cstdint>

#include "base/vec.h"

namespace wellspring {

// `cell` metres a side; never 0.
inline uint64_t place_key(vec3 position, vec3 normal, float cell) {
  vec3 a = glm::abs(normal);
  int axis = a.x > a.y ? (a.x > a.z ? 0 : 2) : (a.y > a.z ? 1 : 2);
  uint64_t side = uint64_t(axis * 2 + (normal[axis] < 0));
  auto part = [&](float x) {
    return uint64_t(int64_t(std::floor(x / cell)) + (1 << 19)) & 0xfffff;
  };
  return ((side << 60 | part(position.x) << 40 | part(position.y) << 20 | part(position.z)) << 1) |
         1;
}

}  // namespace wellspring
