// SPDX-License-Identifier: Apache-2.0
// Chooses among many lights by how much each may send to a place: a tree over their places,
// directions and strengths, walked from the root by the children's importance (Conty Estevez and
// Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting", sections 4 and 5,
// without the splitting). A node has eight children: their importances are computed side by side,
// and few lights, one node, are all asked one by one. Probabilities are exact. A light that may
// send anything is picked with a chance above 0; one that provably sends nothing (behind the
// surface, beyond its cone or reach) is not picked.
//
// Without a tree the choice is by strength alone.
#pragma once
#include <span>
#include <vector>

#include "base/simd.h"
#include "light/random/warp.h"
#include "world/scene.h"

namespace wellspring::light {

// Bounds a light as seen from far away.
struct LightBounds {
  vec3 low{0}, high{0};
  vec3 axis{0, 1, 0};    // main direction of its light, unit
  float cos_spread = 1;  // directions of full strength lie within this of the axis; -1: all
  float cos_reach = 0;   // beyond the spread light fades, and ends at this angle
  float strength = 0;    // radiant intensity along the axis, W/sr; not above 0 or not finite: dark
  float range = std::numeric_limits<float>::infinity();  // light ends at this distance
  bool two_sided = false;                                // emits light along -axis too
};

enum class LightChoice : uint8_t { by_strength, by_place };

struct LightTree {
  static constexpr uint32_t no_leaf = 0xffffffffu;
  // Holds its children: spheres around lights, and cones of their directions. An empty lane has
  // strength 0.
  struct Node {
    Lanes x{}, y{}, z{}, radius{};
    Lanes axis_x{}, axis_y{}, axis_z{};
    Lanes cos_spread{}, sin_spread{}, cos_reach{}, two_sided{};
    Lanes range{}, strength{};
    Lanes inside{};  // importance for places within the sphere
    uint32_t child[lane_count] = {};
    bool is_leaf[lane_count] = {};  // then `child` is a light, else a node
    uint32_t parent = no_leaf, lane_in_parent = 0;
  };
  std::vector<Node> nodes;        // the root first
  std::vector<uint32_t> leaf_of;  // each light's node * lane_count + lane; no_leaf: dark
  // If the choice is by strength alone: lights that are not dark, each `leaf_of` its place here.
  AliasTable strengths;
  std::vector<uint32_t> emitting;
  double total = 0;  // sum of all strengths
  bool empty() const { return !(total > 0); }
};

LightTree make_light_tree(std::span<const LightBounds> lights, LightChoice choice);

struct LightPick {
  uint32_t index = 0;
  float probability = 0;  // 0: no light reaches the place
  float u = 0;            // the rest of the number: uniform again in [0, 1)
};
// Picks a light for a place on a surface that is lit from the side of `normal`; normal 0: from all
// sides. The tree must not be empty. u in [0, 1).
LightPick pick_light(const LightTree& tree, vec3 place, vec3 normal, float u);
// Returns the probability with which that place picks light `index`.
float pick_light_probability(const LightTree& tree, vec3 place, vec3 normal, uint32_t index);

}  // namespace wellspring::light
