// SPDX-License-Identifier: Apache-2.0
// Emitting triangles in a few groups of neighbours, so that a place asks the lights near it and before it
// more often than those far away or behind: a two-level choice whose probabilities are exact.
#pragma once
#include <span>
#include <vector>

#include "light/alias_table.h"
#include "world/scene.h"

namespace wellspring {

struct EmitterTriangle;

inline constexpr int most_emitter_groups = 32;

struct EmitterGroups {
  std::vector<vec3> centre;       // of each group's sphere
  std::vector<float> radius2;     // squared
  std::vector<float> power;
  std::vector<uint32_t> members;  // indices of triangles, group by group
  std::vector<uint32_t> first;    // of each group in members, and the end
  std::vector<AliasTable> choice;  // within each group, by power
  std::vector<uint16_t> group_of;  // each triangle
  std::vector<float> share;        // each triangle's probability within its group
  double total = 0;                // power of all
  bool empty() const { return power.empty(); }
};

// At most `most` groups (one: by power alone). `power[i]` of emitters[i]; those without power are in no group that is ever picked.
EmitterGroups make_emitter_groups(std::span<const EmitterTriangle> emitters, std::span<const float> power,
                                  int most = most_emitter_groups);

struct EmitterPick {
  uint32_t index = 0;
  float probability = 0;
  float u = 0;  // what is left of the number
};
// For a place with a surface facing along `normal`. `groups` must not be empty. u in [0, 1).
EmitterPick sample_group(const EmitterGroups& groups, vec3 place, vec3 normal, float u);
// The probability with which that place picks triangle `index`.
float sample_group_probability(const EmitterGroups& groups, vec3 place, vec3 normal, uint32_t index);

}  // namespace wellspring
