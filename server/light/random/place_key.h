// SPDX-License-Identifier: Apache-2.0
// Cells of space and of a surface's main direction, by which light at places is remembered in hash
// tables (Binder, Fricke, Keller 2019, "Massively Parallel Path Space Filtering", section 3).
#pragma once
#include <cmath>
#include <cstdint>
#include <span>

#include "base/rng.h"
#include "base/vec.h"

namespace wellspring::light {

// `cell` metres a side; the key is never 0.
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

// The cell lies between `cell` times this and `cell` times one more.
inline glm::ivec3 place_of_key(uint64_t key) {
  auto part = [&](int shift) { return int(key >> (shift + 1) & 0xfffff) - (1 << 19); };
  return {part(40), part(20), part(0)};
}

// The slot of `key` in an open-addressed table with linear probing: the one that holds it, or the
// free one (0) where it would be put. As many `keys` as a power of two, at least one of them free.
inline uint32_t find_place_slot(std::span<const uint64_t> keys, uint64_t key) {
  const uint32_t mask = uint32_t(keys.size()) - 1;
  uint32_t slot = uint32_t(mix64(key)) & mask;
  while (keys[slot] != 0 && keys[slot] != key) slot = (slot + 1) & mask;
  return slot;
}

}  // namespace wellspring::light
