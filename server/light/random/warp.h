// SPDX-License-Identifier: Apache-2.0
// Bends uniform numbers in [0, 1) into directions and points, with densities, and makes the frames
// for them.
#pragma once
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "base/rng.h"
#include "base/vec.h"

namespace wellspring::light {

// Makes two unit vectors that complete `n` to a right-handed frame (Duff et al. 2017, JCGT 6(1)).
inline void make_frame_axes(vec3 n, vec3& tangent, vec3& bitangent) {
  float sign = std::copysign(1.0f, n.z);
  float a = -1 / (sign + n.z), b = n.x * n.y * a;
  tangent = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
  bitangent = {b, sign + n.y * n.y * a, -n.y};
}

// Returns cosine and sine of a share of a full turn, u in [0, 1], within 1e-7.
inline vec2 unit_circle(float u) {
  float quarter = u * 4;
  int turn = int(quarter + 0.5f);
  float x = (quarter - float(turn)) * (pi / 2), x2 = x * x;
  float s = x * (1 + x2 * (-1 / 6.0f + x2 * (1 / 120.0f + x2 * (-1 / 5040.0f + x2 / 362880.0f))));
  float c = 1 + x2 * (-0.5f + x2 * (1 / 24.0f + x2 * (-1 / 720.0f + x2 / 40320.0f)));
  if (turn & 1) std::swap(s, c), c = -c;
  return turn & 2 ? vec2(-c, -s) : vec2(c, s);
}

// Returns a direction with density z / pi; z is up.
inline vec3 sample_cosine_hemisphere(vec2 u) {
  return {std::sqrt(u.x) * unit_circle(u.y), std::sqrt(std::max(0.0f, 1 - u.x))};
}

// Returns a direction, uniform over the sphere.
inline vec3 sample_sphere(vec2 u) {
  float z = 1 - 2 * u.x, radius = std::sqrt(std::max(0.0f, 1 - z * z));
  return {radius * unit_circle(u.y), z};
}

// Returns barycentric weights of the second and third corner, uniform over the triangle.
inline vec2 sample_triangle(vec2 u) {
  float root = std::sqrt(u.x);
  return {root * (1 - u.y), root * u.y};
}

// Returns the weight of a sample drawn with density `own` that another strategy could have drawn
// with density `other`: the power heuristic with exponent 2 (Veach 1997, section 9.2.4). An
// infinite density wins.
inline float mis_weight(float own, float other) {
  if (other <= 0) return 1;
  float ratio = other / own;
  return 1 / (1 + ratio * ratio);
}

// Names cells of space and of a surface's main direction, for hash tables that keep light at places
// (Binder, Fricke, Keller 2019, "Massively Parallel Path Space Filtering", section 3).

// Returns the key of a place's cell, `cell` metres a side; it is never 0.
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

// Returns the place of a key's cell, which lies between `cell` times this and `cell` times one
// more.
inline glm::ivec3 place_of_key(uint64_t key) {
  auto part = [&](int shift) { return int(key >> (shift + 1) & 0xfffff) - (1 << 19); };
  return {part(40), part(20), part(0)};
}

// Returns the slot of `key` in an open-addressed table with linear probing: the one that holds it,
// or the free one (0) where it would be put. The number of `keys` is a power of two, and at least
// one is free.
inline uint32_t find_place_slot(std::span<const uint64_t> keys, uint64_t key) {
  const uint32_t mask = uint32_t(keys.size()) - 1;
  uint32_t slot = uint32_t(mix64(key)) & mask;
  while (keys[slot] != 0 && keys[slot] != key) slot = (slot + 1) & mask;
  return slot;
}

// Picks an index with probability proportional to its weight in constant time (Walker 1977, built
// as Vose 1991). Weights that are negative or not finite count as 0.

struct AliasTable {
  struct Cell {
    float keep = 1;         // chance that this cell stands for itself
    uint32_t other = 0;     // index that it stands for otherwise
    float probability = 0;  // probability of this index, over the whole table
  };
  std::vector<Cell> cells;  // empty: all weights are 0
  double total = 0;         // sum of the weights
};

AliasTable make_alias_table(std::span<const float> weights);

struct AliasPick {
  uint32_t index;
  float u;  // rest of the number, uniform again
};
// The table must not be empty. u in [0, 1).
inline AliasPick sample_alias(const AliasTable& table, float u) {
  float scaled = u * float(table.cells.size());
  uint32_t i = uint32_t(scaled);
  if (i >= table.cells.size()) i = uint32_t(table.cells.size() - 1);
  float rest = scaled - float(i);
  const AliasTable::Cell& cell = table.cells[i];
  if (rest < cell.keep) return {i, rest / cell.keep};
  return {cell.other, (rest - cell.keep) / (1 - cell.keep)};
}

}  // namespace wellspring::light
