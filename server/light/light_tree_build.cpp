// SPDX-License-Identifier: Apache-2.0
// Building a LightTree from the top: each set of lights is split where the halves together cover
// the least area and angle, weighted by strength (Conty Estevez and Kulla 2018, section 4).
#include <algorithm>
#include <cmath>
#include <numeric>

#include "light/light_tree.h"

namespace wellspring {
namespace {

constexpr int buckets = 12;
constexpr int deepest_fitted = 48;  // below it halves are equal, so no input makes a long tree

float angle_of(float cosine) { return std::acos(glm::clamp(cosine, -1.0f, 1.0f)); }

// The smallest cone around two cones, each an axis and an angle (algorithm 1 of the paper).
void join_cones(LightBounds& a, const LightBounds& b) {
  float spread_a = angle_of(a.cos_spread), spread_b = angle_of(b.cos_spread);
  vec3 axis_a = a.axis, axis_b = b.axis;
  if (spread_b > spread_a) std::swap(spread_a, spread_b), std::swap(axis_a, axis_b);
  bool two_sided = a.two_sided || b.two_sided;
  if (two_sided && dot(axis_a, axis_b) < 0) axis_b = -axis_b;
  float between = angle_of(dot(axis_a, axis_b));
  a.two_sided = two_sided;
  a.axis = axis_a;
  if (std::min(between + spread_b, pi) <= spread_a) {
    a.cos_spread = std::cos(spread_a);
    return;
  }
  // A little wider, for what rounding cuts off.
  float spread = 0.5f * (spread_a + between + spread_b) + 1e-3f;
  vec3 side = axis_b - axis_a * dot(axis_a, axis_b);
  float length2 = dot(side, side);
  if (spread >= pi || !(length2 > 1e-12f)) {
    a.cos_spread = spread >= pi || between > 1 ? -1 : std::cos(spread_a + between + spread_b);
    return;
  }
  float turn = spread - spread_a;
  a.axis = axis_a * std::cos(turn) + side / std::sqrt(length2) * std::sin(turn);
  a.axis /= length(a.axis);
  a.cos_spread = std::cos(spread);
}

LightBounds join(const LightBounds& a, const LightBounds& b) {
  if (!(a.strength > 0)) return b;
  if (!(b.strength > 0)) return a;
  LightBounds all = a;
  all.low = glm::min(a.low, b.low);
  all.high = glm::max(a.high, b.high);
  all.cos_reach = std::min(a.cos_reach, b.cos_reach);
  all.strength = a.strength + b.strength;
  all.range = std::max(a.range, b.range);
  join_cones(all, b);
  return all;
}

// Strength times solid angle times area: what a set costs (section 4.2).
float cost_of(const LightBounds& b) {
  float spread = angle_of(b.cos_spread);
  float most = std::min(spread + angle_of(b.cos_reach), pi);
  float angle = 2 * pi * (1 - std::cos(spread)) +
                0.5f * pi * (2 * most * std::sin(spread) - std::cos(spread - 2 * most) -
                             2 * spread * std::sin(spread) + std::cos(spread));
  vec3 d = b.high - b.low;
  float area = 2 * (d.x * d.y + d.y * d.z + d.z * d.x) + 1e-3f * dot(d, d);
  return b.strength * (b.two_sided ? 2 : 1) * std::max(angle, 1e-3f) * area;
}

vec3 middle(const LightBounds& b) { return 0.5f * b.low + 0.5f * b.high; }

struct Builder {
  std::span<const LightBounds> lights;
  std::vector<uint32_t> order;
  LightTree& tree;

  // Where to part order[begin, end): along the axis and plane that cost least, or in the middle of
  // the longest axis.
  uint32_t split(uint32_t begin, uint32_t end, int depth) {
    Bounds box;
    for (uint32_t i = begin; i < end; i++) {
      box.low = glm::min(box.low, middle(lights[order[i]]));
      box.high = glm::max(box.high, middle(lights[order[i]]));
    }
    vec3 size = box.high - box.low;
    float least = std::numeric_limits<float>::infinity();
    int best_axis = -1, best_bucket = 0;
    auto bucket_of = [&](uint32_t light, int axis) {
      float t = (middle(lights[light])[axis] - box.low[axis]) / size[axis];
      return std::clamp(int(t * buckets), 0, buckets - 1);
    };
    for (int axis = 0; axis < 3 && depth < deepest_fitted; axis++) {
      if (!(size[axis] > 0) || !std::isfinite(size[axis])) continue;
      LightBounds part[buckets], above[buckets];
      for (uint32_t i = begin; i < end; i++) {
        LightBounds& into = part[bucket_of(order[i], axis)];
        into = join(into, lights[order[i]]);
      }
      above[buckets - 1] = part[buckets - 1];
      for (int i = buckets - 2; i > 0; i--) above[i] = join(part[i], above[i + 1]);
      LightBounds below;
      for (int i = 0; i + 1 < buckets; i++) {
        below = join(below, part[i]);
        if (!(below.strength > 0) || !(above[i + 1].strength > 0)) continue;
        // Thin slabs are not cut lengthwise.
        float longest = max_component(size) / size[axis];
        float cost = longest * (cost_of(below) + cost_of(above[i + 1]));
        if (cost < least) least = cost, best_axis = axis, best_bucket = i;
      }
    }
    auto first = order.begin() + begin, last = order.begin() + end;
    if (best_axis >= 0) {
      auto parted = std::partition(
          first, last, [&](uint32_t i) { return bucket_of(i, best_axis) <= best_bucket; });
      if (parted != first && parted != last) return uint32_t(parted - order.begin());
    }
    int axis = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    auto half = first + (last - first) / 2;
    std::nth_element(first, half, last, [&](uint32_t a, uint32_t b) {
      return middle(lights[a])[axis] < middle(lights[b])[axis];
    });
    return uint32_t(half - order.begin());
  }

  LightTree::Node fill(const LightBounds& b) const {
    LightTree::Node node;
    node.centre = middle(b);
    vec3 half = 0.5f * b.high - 0.5f * b.low;
    node.radius2 = dot(half, half) * 1.00001f;
    node.axis = b.axis;
    node.strength = b.strength;
    node.cos_spread = b.cos_spread;
    node.sin_spread = std::sqrt(std::max(0.0f, 1 - b.cos_spread * b.cos_spread));
    node.cos_reach = b.cos_reach;
    node.range = b.range * 1.00001f;
    node.two_sided = b.two_sided;
    return node;
  }

  // Fills node `at` with order[begin, end); their bounds.
  LightBounds build(uint32_t at, uint32_t begin, uint32_t end, int depth) {
    LightBounds all;
    uint32_t child = 0;
    if (end - begin == 1) {
      all = lights[order[begin]];
      tree.leaf_of[order[begin]] = at;
    } else {
      uint32_t middle = split(begin, end, depth);
      child = uint32_t(tree.nodes.size());
      tree.nodes.resize(child + 2);
      all = join(build(child, begin, middle, depth + 1), build(child + 1, middle, end, depth + 1));
    }
    uint32_t parent = tree.nodes[at].parent;
    tree.nodes[at] = fill(all);
    tree.nodes[at].parent = parent;
    tree.nodes[at].child = child;
    tree.nodes[at].light = order[begin];
    if (child) tree.nodes[child].parent = tree.nodes[child + 1].parent = at;
    return all;
  }
};

}  // namespace

LightTree make_light_tree(std::span<const LightBounds> lights, LightChoice choice) {
  LightTree tree;
  std::vector<float> strength;
  Builder builder{lights, {}, tree};
  for (uint32_t i = 0; i < lights.size(); i++) {
    const LightBounds& b = lights[i];
    bool shines = b.strength > 0 && std::isfinite(b.strength) && is_finite(b.low) &&
                  is_finite(b.high) && is_finite(b.axis);
    strength.push_back(shines ? b.strength * (b.two_sided ? 2 : 1) : 0);
    if (!shines) continue;
    builder.order.push_back(i);
    tree.total += double(strength.back());
  }
  if (builder.order.empty()) return tree;
  tree.leaf_of.assign(lights.size(), LightTree::no_leaf);
  uint32_t count = uint32_t(builder.order.size());
  if (choice == LightChoice::by_strength) {
    tree.nodes.resize(count);
    std::vector<float> shining;
    for (uint32_t i = 0; i < count; i++) {
      builder.build(i, i, i + 1, 0);
      shining.push_back(strength[builder.order[i]]);
    }
    tree.strengths = make_alias_table(shining);
  } else if (count <= LightTree::few) {
    tree.nodes.resize(count);
    for (uint32_t i = 0; i < count; i++) builder.build(i, i, i + 1, 0);
  } else {
    tree.nodes.reserve(2 * count);
    tree.nodes.resize(1);
    builder.build(0, 0, count, 0);
  }
  return tree;
}

}  // namespace wellspring
