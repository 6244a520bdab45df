// SPDX-License-Identifier: Apache-2.0
// A choice among many lights by how much each may send to a place: a binary tree over their places,
// directions and strengths, walked from the root by the children's importance (Conty Estevez and
// Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting", sections 4 and 5,
// without the splitting). Probabilities are exact. A light that may send anything is picked with a
// chance above 0; one that provably sends nothing (behind the surface, beyond its cone or reach)
// is not picked.
//
// Few lights are asked one by one, which knows each better than a tree does. Without a tree the
// choice is by strength alone.
#pragma once
#include <span>
#include <vector>

#include "light/alias_table.h"
#include "world/scene.h"

namespace wellspring {

// What is known of a light from far away.
struct LightBounds {
  vec3 low{0}, high{0};
  vec3 axis{0, 1, 0};    // main direction of its light, unit
  float cos_spread = 1;  // directions of full strength lie within this of the axis; -1: all
  float cos_reach = 0;   // beyond the spread it fades, and ends at this angle
  float strength = 0;    // radiant intensity along the axis, W/sr; not above 0 or not finite: dark
  float range = std::numeric_limits<float>::infinity();  // it ends at this distance
  bool two_sided = false;                                // shines along -axis too
};

enum class LightChoice : uint8_t { by_strength, by_place };

struct LightTree {
  struct Node {
    vec3 centre{0};
    float radius2 = 0;  // squared, of a sphere around all
    vec3 axis{0, 1, 0};
    float strength = 0;
    float cos_spread = 1, sin_spread = 0, cos_reach = 0;
    float range = 0;
    uint32_t light = 0;  // of a leaf
    uint32_t child = 0;  // index of the first of two; 0: a leaf
    uint32_t parent = 0;
    bool two_sided = false;
  };
  static constexpr size_t few = 8;  // so many lights are asked one by one
  std::vector<Node> nodes;          // the root first; of few lights only leaves
  std::vector<uint32_t> leaf_of;    // each light's node; no_leaf: dark
  AliasTable strengths;             // where the choice is by strength alone
  double total = 0;                 // strength of all
  static constexpr uint32_t no_leaf = 0xffffffffu;
  bool empty() const { return !(total > 0); }
};

LightTree make_light_tree(std::span<const LightBounds> lights, LightChoice choice);

struct LightPick {
  uint32_t index = 0;
  float probability = 0;  // 0: no light reaches the place
  float u = 0;            // what is left of the number: uniform again in [0, 1)
};
// For a place on a surface that is lit from the side of `normal`; normal 0: from all sides. The
// tree must not be empty. u in [0, 1).
LightPick pick_light(const LightTree& tree, vec3 place, vec3 normal, float u);
// The probability with which that place picks light `index`.
float pick_light_probability(const LightTree& tree, vec3 place, vec3 normal, uint32_t index);

}  // namespace wellspring
