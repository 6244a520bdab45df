// SPDX-License-Identifier: Apache-2.0
#include "light/sample/light_tree.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

namespace wellspring::light {
namespace {

using Node = LightTree::Node;

constexpr float below_one = 0x1.fffffep-1f;

// Holds upper bounds of what a node's children send to a surface, but for a constant (section 5.2).
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
  // The sphere is seen under twice this angle.
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
  // `emits` is the cosine of the angle beyond the spread, less the angle of the sphere.
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

// Builds a LightTree from the top: each set of lights is split where the halves together cover the
// least area and angle, weighted by strength (Conty Estevez and Kulla 2018, section 4), and the
// costliest part again until a node has all its children.

namespace {

constexpr int buckets = 12;
// Below this depth halves are equal, so no input makes a long tree
constexpr int deepest_fitted = 48;

float angle_of(float cosine) { return std::acos(glm::clamp(cosine, -1.0f, 1.0f)); }

// Makes `a` the smallest cone around two cones, each an axis and an angle (algorithm 1 of the
// paper).
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
  // The cone is a little wider, for what rounding cuts off.
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

// Returns what a set costs: strength times solid angle times area (section 4.2).
float cost_of(const LightBounds& b) {
  float spread = angle_of(b.cos_spread);
  float most = std::min(spread + angle_of(b.cos_reach), pi);
  float angle = 2 * pi * (1 - std::cos(spread)) +
                0.5f * pi *
                    (2 * most * std::sin(spread) - std::cos(spread - 2 * most) -
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

  // Parts order[begin, end) along the axis and plane that cost least, or in the middle of the
  // longest axis; returns where.
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

  // Holds lights order[begin, end) as a child of some node.
  struct Part {
    uint32_t begin, end;
    int depth;  // splits from the root
    LightBounds bounds;
    float cost = 0;  // cost of leaving it whole
  };

  Part part_of(uint32_t begin, uint32_t end, int depth) const {
    Part part{begin, end, depth, {}};
    for (uint32_t i = begin; i < end; i++) part.bounds = join(part.bounds, lights[order[i]]);
    float cost = end - begin > 1 ? cost_of(part.bounds) : 0;
    part.cost = end - begin > 1 && !(cost > 0) ? 1e-30f : cost;
    return part;
  }

  void fill(LightTree::Node& node, uint32_t lane, const LightBounds& b) const {
    vec3 centre = middle(b), half = 0.5f * b.high - 0.5f * b.low;
    float radius = std::sqrt(dot(half, half)) * 1.00001f;
    node.x[lane] = centre.x, node.y[lane] = centre.y, node.z[lane] = centre.z;
    node.radius[lane] = radius;
    node.axis_x[lane] = b.axis.x, node.axis_y[lane] = b.axis.y, node.axis_z[lane] = b.axis.z;
    bool all_around = b.cos_spread <= -1;  // no cosine, however rounded, is beyond it
    node.cos_spread[lane] = all_around ? -2 : b.cos_spread;
    node.sin_spread[lane] =
        all_around ? 0 : std::sqrt(std::max(0.0f, 1 - b.cos_spread * b.cos_spread));
    node.cos_reach[lane] = b.cos_reach;
    node.two_sided[lane] = b.two_sided;
    node.range[lane] = b.range * 1.00001f;
    node.strength[lane] = b.strength;
    node.inside[lane] = std::min(b.strength / std::max(radius * radius, 1e-20f), 1e30f);
  }

  // Fills node `at` with the children of `whole`.
  void build(uint32_t at, const Part& whole) {
    std::vector<Part> parts = {whole};
    while (parts.size() < lane_count) {
      auto costliest = std::max_element(
          parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.cost < b.cost; });
      if (!(costliest->cost > 0)) break;
      Part part = *costliest;
      uint32_t middle = split(part.begin, part.end, part.depth);
      // Neighbours remain neighbours: a number that is well spread is then well spread over places,
      // too.
      *costliest = part_of(part.begin, middle, part.depth + 1);
      parts.insert(costliest + 1, part_of(middle, part.end, part.depth + 1));
    }
    for (uint32_t lane = 0; lane < parts.size(); lane++) {
      const Part& part = parts[lane];
      fill(tree.nodes[at], lane, part.bounds);
      bool is_leaf = part.end - part.begin == 1;
      uint32_t child = is_leaf ? order[part.begin] : uint32_t(tree.nodes.size());
      tree.nodes[at].child[lane] = child;
      tree.nodes[at].is_leaf[lane] = is_leaf;
      if (is_leaf) {
        tree.leaf_of[child] = at * lane_count + lane;
        continue;
      }
      tree.nodes.emplace_back();
      tree.nodes[child].parent = at;
      tree.nodes[child].lane_in_parent = lane;
      build(child, part);
    }
  }
};

}  // namespace

LightTree make_light_tree(std::span<const LightBounds> lights, LightChoice choice) {
  LightTree tree;
  std::vector<float> strength;
  Builder builder{lights, {}, tree};
  for (uint32_t i = 0; i < lights.size(); i++) {
    const LightBounds& b = lights[i];
    bool emits = b.strength > 0 && std::isfinite(b.strength) && is_finite(b.low) &&
                 is_finite(b.high) && is_finite(b.axis);
    strength.push_back(emits ? b.strength * (b.two_sided ? 2 : 1) : 0);
    if (!emits) continue;
    builder.order.push_back(i);
    tree.total += double(strength.back());
  }
  if (builder.order.empty()) return tree;
  tree.leaf_of.assign(lights.size(), LightTree::no_leaf);
  if (choice == LightChoice::by_strength) {
    std::vector<float> emitting;
    for (uint32_t light : builder.order) {
      tree.leaf_of[light] = uint32_t(emitting.size());
      emitting.push_back(strength[light]);
    }
    tree.emitting = builder.order;
    tree.strengths = make_alias_table(emitting);
    return tree;
  }
  tree.nodes.emplace_back();
  builder.build(0, builder.part_of(0, uint32_t(builder.order.size()), 0));
  return tree;
}

}  // namespace wellspring::light
