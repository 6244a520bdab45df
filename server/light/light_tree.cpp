// SPDX-License-Identifier: Apache-2.0
#include "light/light_tree.h"

#include <cmath>

namespace wellspring {
namespace {

using Node = LightTree::Node;

float root(float x) { return std::sqrt(std::max(0.0f, x)); }

// An upper bound of what the node sends to a surface there, but for a constant (section 5.2).
float importance(const Node& node, vec3 place, vec3 normal) {
  vec3 line = node.centre - place;
  float distance2 = dot(line, line);
  if (distance2 <= node.radius2) return node.strength / std::max(node.radius2, 1e-20f);
  distance2 = std::max(distance2, 1e-20f);
  float distance = std::sqrt(distance2);
  if (distance - root(node.radius2) > node.range) return 0;
  vec3 to_light = line / distance;
  // Half the angle under which the sphere is seen.
  float sin2 = node.radius2 / distance2, sin_seen = std::sqrt(sin2), cos_seen = root(1 - sin2);
  float facing = 1;
  if (normal != vec3(0)) {
    float cosine = dot(to_light, normal);
    if (cosine < cos_seen) {
      cosine = cosine * cos_seen + root(1 - cosine * cosine) * sin_seen;
      if (cosine <= 0) return 0;
      facing = cosine;
    }
  }
  float shines = 1;
  if (node.cos_spread > -1) {
    float cosine = -dot(node.axis, to_light);
    if (node.two_sided) cosine = std::abs(cosine);
    if (cosine < node.cos_spread) {
      // The angle beyond the spread, less the angle of the sphere.
      float sine = root(1 - cosine * cosine);
      float c = cosine * node.cos_spread + sine * node.sin_spread;
      float s = sine * node.cos_spread - cosine * node.sin_spread;
      if (c < cos_seen) {
        shines = c * cos_seen + s * sin_seen;
        if (shines <= node.cos_reach) return 0;
        shines = std::max(shines, 1e-4f);
      }
    }
  }
  // The floor keeps a chance for glossy lobes at grazing angles.
  constexpr float grazing = 0.05f;
  return std::min(node.strength * shines * (facing + grazing) / distance2, 1e30f);
}

bool is_few(const LightTree& tree) { return tree.nodes.size() <= LightTree::few; }

constexpr float below_one = 0x1.fffffep-1f;

// Importances of all leaves; their sum.
float weigh_all(const LightTree& tree, vec3 place, vec3 normal, float* weight) {
  float sum = 0;
  for (size_t i = 0; i < tree.nodes.size(); i++)
    sum += weight[i] = importance(tree.nodes[i], place, normal);
  return sum;
}

LightPick pick_of_few(const LightTree& tree, vec3 place, vec3 normal, float u) {
  if (tree.nodes.size() == 1) return {tree.nodes[0].light, 1, u};
  float weight[LightTree::few];
  float sum = weigh_all(tree, place, normal, weight);
  LightPick pick;
  if (!(sum > 0)) return pick;
  float left = u * sum;
  size_t chosen = tree.nodes.size();
  for (size_t i = 0; i < tree.nodes.size(); i++) {
    if (!(weight[i] > 0)) continue;
    chosen = i;
    if (left < weight[i]) break;
    left -= weight[i];
  }
  pick.index = tree.nodes[chosen].light;
  pick.probability = weight[chosen] / sum;
  pick.u = glm::clamp(left / weight[chosen], 0.0f, below_one);
  return pick;
}

}  // namespace

LightPick pick_light(const LightTree& tree, vec3 place, vec3 normal, float u) {
  if (!tree.strengths.cells.empty()) {
    AliasPick pick = sample_alias(tree.strengths, u);
    return {tree.nodes[pick.index].light, tree.strengths.cells[pick.index].probability,
            std::min(pick.u, below_one)};
  }
  if (is_few(tree)) return pick_of_few(tree, place, normal, u);
  LightPick pick;
  float probability = 1;
  uint32_t at = 0;
  while (uint32_t child = tree.nodes[at].child) {
    float first = importance(tree.nodes[child], place, normal);
    float second = importance(tree.nodes[child + 1], place, normal);
    float sum = first + second;
    if (!(sum > 0)) return pick;
    float share = first / sum;
    if (u < share) {
      at = child;
      u = std::min(u / share, below_one);
      probability *= share;
    } else {
      at = child + 1;
      u = std::min((u - share) / (1 - share), below_one);
      probability *= second / sum;
    }
  }
  pick.index = tree.nodes[at].light;
  pick.probability = probability;
  pick.u = u;
  return pick;
}

float pick_light_probability(const LightTree& tree, vec3 place, vec3 normal, uint32_t index) {
  uint32_t at = tree.leaf_of[index];
  if (at == LightTree::no_leaf) return 0;
  if (!tree.strengths.cells.empty()) return tree.strengths.cells[at].probability;
  if (is_few(tree)) {
    if (tree.nodes.size() == 1) return 1;
    float weight[LightTree::few];
    float sum = weigh_all(tree, place, normal, weight);
    return sum > 0 ? weight[at] / sum : 0;
  }
  float probability = 1;
  while (at != 0) {
    uint32_t child = tree.nodes[tree.nodes[at].parent].child;
    float first = importance(tree.nodes[child], place, normal);
    float second = importance(tree.nodes[child + 1], place, normal);
    float mine = at == child ? first : second;
    if (!(mine > 0)) return 0;
    probability *= mine / (first + second);
    at = tree.nodes[at].parent;
  }
  return probability;
}

}  // namespace wellspring
