// SPDX-License-Identifier: Apache-2.0
#include "light/sample/light_tree.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace wellspring::light {
namespace {

using Node = LightTree::Node;

constexpr float below_one = 0x1.fffffep-1f;

// Upper bounds of what a node's children send to a surface there, but for a constant (section 5.2).
struct Importances {
  alignas(Lanes) float of[lane_count];
  float sum;
};

Importances importances(const Node& node, vec3 place, vec3 normal) {
  const Lanes zero{}, one = all_lanes(1);
  Lanes x = node.x - place.x, y = node.y - place.y, z = node.z - place.z;
  Lanes distance2 = x * x + y * y + z * z;
  LaneMask inside = distance2 <= node.radius * node.radius;
  Lanes distance = lanes_sqrt(lanes_max(distance2, all_lanes(1e-20f))), inverse = 1 / distance;
  // Half the angle under which the sphere is seen.
  Lanes sin_seen = lanes_min(node.radius * inverse, one);
  Lanes cos_seen = lanes_sqrt(1 - sin_seen * sin_seen);
  LaneMask reaches = distance - node.radius <= node.range;
  Lanes facing = one;
  if (normal != vec3(0)) {
    Lanes cosine = lanes_min((x * normal.x + y * normal.y + z * normal.z) * inverse, one);
    Lanes sine = lanes_sqrt(lanes_max(1 - cosine * cosine, zero));
    facing = cosine < cos_seen ? cosine * cos_seen + sine * sin_seen : one;
    reaches = reaches & (facing > zero);
  }
  Lanes cosine = -(x * node.axis_x + y * node.axis_y + z * node.axis_z) * inverse;
  cosine = node.two_sided > zero ? lanes_abs(cosine) : cosine;
  Lanes sine = lanes_sqrt(lanes_max(1 - cosine * cosine, zero));
  // The angle beyond the spread, less the angle of the sphere.
  Lanes c = cosine * node.cos_spread + sine * node.sin_spread;
  Lanes s = sine * node.cos_spread - cosine * node.sin_spread;
  Lanes emits = c * cos_seen + s * sin_seen;
  LaneMask full = (cosine >= node.cos_spread) | (c >= cos_seen);
  reaches = reaches & (full | (emits > node.cos_reach));
  emits = full ? one : lanes_max(emits, all_lanes(1e-4f));
  // The floor keeps a chance for glossy lobes at grazing angles.
  constexpr float grazing = 0.05f;
  Lanes importance = node.strength * emits * (facing + grazing) * (inverse * inverse);
  importance = reaches ? lanes_min(importance, all_lanes(1e30f)) : zero;
  importance = inside ? node.inside : importance;
  Importances all;
  std::memcpy(all.of, &importance, sizeof(importance));
  all.sum = lanes_sum(importance);
  return all;
}

}  // namespace

LightPick pick_light(const LightTree& tree, vec3 place, vec3 normal, float u) {
  LightPick pick;
  if (!tree.strengths.cells.empty()) {
    AliasPick chosen = sample_alias(tree.strengths, u);
    return {tree.emitting[chosen.index], tree.strengths.cells[chosen.index].probability,
            std::min(chosen.u, below_one)};
  }
  float probability = 1;
  uint32_t at = 0;
  while (true) {
    const Node& node = tree.nodes[at];
    Importances importance = importances(node, place, normal);
    if (!(importance.sum > 0)) return pick;
    float left = u * importance.sum;
    int chosen = -1;
    for (int i = 0; i < lane_count; i++) {
      if (!(importance.of[i] > 0)) continue;
      chosen = i;
      if (left < importance.of[i]) break;
      left -= importance.of[i];
    }
    u = glm::clamp(left / importance.of[chosen], 0.0f, below_one);
    probability *= importance.of[chosen] / importance.sum;
    at = node.child[chosen];
    if (node.is_leaf[chosen]) return {at, probability, u};
  }
}

float pick_light_probability(const LightTree& tree, vec3 place, vec3 normal, uint32_t index) {
  if (tree.leaf_of[index] == LightTree::no_leaf) return 0;
  if (!tree.strengths.cells.empty()) return tree.strengths.cells[tree.leaf_of[index]].probability;
  uint32_t at = tree.leaf_of[index] / lane_count, lane = tree.leaf_of[index] % lane_count;
  float probability = 1;
  while (at != LightTree::no_leaf) {
    const Node& node = tree.nodes[at];
    Importances importance = importances(node, place, normal);
    if (!(importance.of[lane] > 0)) return 0;
    probability *= importance.of[lane] / importance.sum;
    lane = node.lane_in_parent;
    at = node.parent;
  }
  return probability;
}

}  // namespace wellspring::light
