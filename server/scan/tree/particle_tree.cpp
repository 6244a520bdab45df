// SPDX-License-Identifier: Apache-2.0
#include "scan/tree/particle_tree.h"

#include <algorithm>
#include <limits>

#include "scan/tree/box_shadow.h"

namespace wellspring::scan {

struct ParticleTree::Split {
  int axis = -1;  // -1: none
  float place = 0;
};

// Returns a split between the spheres and one side of the box, if there is free space.
ParticleTree::Split ParticleTree::void_split(const Box& box, uint32_t first, uint32_t count,
                                             int axis) const {
  float low = std::numeric_limits<float>::infinity(), high = -low;
  for (uint32_t i = first; i < first + count; i++) {
    const Sphere& sphere = spheres_[order_[i]];
    low = std::min(low, sphere.place[axis] - sphere.radius);
    high = std::max(high, sphere.place[axis] + sphere.radius);
  }
  const float least = settings_.least_gap * (box.high[axis] - box.low[axis]);
  const float below = low - box.low[axis], above = box.high[axis] - high;
  if (std::max(below, above) <= least) return {};
  return {axis, below >= above ? low : high};
}

void ParticleTree::find_reach(ParticleNode& node) const {
  if (node.count == 0) return;
  node.reach = {vec3(std::numeric_limits<float>::infinity()),
                vec3(-std::numeric_limits<float>::infinity())};
  for (uint32_t i = node.first; i < node.first + node.count; i++) {
    const Sphere& sphere = spheres_[order_[i]];
    node.reach.low = glm::min(node.reach.low, sphere.place - sphere.radius);
    node.reach.high = glm::max(node.reach.high, sphere.place + sphere.radius);
  }
}

// Moves spheres below the split to the front, and returns where the others begin.
uint32_t ParticleTree::divide(const Split& split, uint32_t first, uint32_t count) {
  const auto begin = order_.begin() + first;
  return first + uint32_t(std::partition(begin, begin + count,
                                         [&](uint32_t i) {
                                           return spheres_[i].place[split.axis] < split.place;
                                         }) -
                          begin);
}

// Looks for the first split of free space here and below, where cells are halved for a try.
ParticleTree::Split ParticleTree::find_split(const Box& box, uint32_t first, uint32_t count,
                                             int axis, int depth) {
  if (count == 0 || depth == 0) return {};
  if (const Split split = void_split(box, first, count, axis); split.axis >= 0) return split;
  const Split middle{axis, (box.low[axis] + box.high[axis]) / 2};
  const uint32_t half = divide(middle, first, count);
  Box lower = box, upper = box;
  lower.high[axis] = upper.low[axis] = middle.place;
  const int next = (axis + 1) % 3;
  const Split split = find_split(lower, first, half - first, next, depth - 1);
  return split.axis >= 0 ? split : find_split(upper, half, first + count - half, next, depth - 1);
}

void ParticleTree::build(uint32_t number, int axis, int depth) {
  const ParticleNode node = nodes_[number];
  if (node.count == 0) return;
  std::vector<Sphere> inside;
  inside.reserve(node.count);
  for (uint32_t i = node.first; i < node.first + node.count; i++)
    inside.push_back(spheres_[order_[i]]);
  const float opacity = sample_opacity(node.box, inside, settings_.lines, number);
  nodes_[number].opacity = nodes_[number].most_opacity = opacity;
  inside = {};
  if (depth == 0 || node.count < 2) return;
  Split split = find_split(node.box, node.first, node.count, axis, depth);
  // A split that was found far below may touch this box's rim alone.
  if (split.axis < 0 || split.place <= node.box.low[split.axis] ||
      split.place >= node.box.high[split.axis])
    split = {axis, (node.box.low[axis] + node.box.high[axis]) / 2};
  const uint32_t half = divide(split, node.first, node.count);
  const auto child = uint32_t(nodes_.size());
  ParticleNode lower, upper;
  lower.box = upper.box = node.box;
  lower.box.high[split.axis] = upper.box.low[split.axis] = split.place;
  lower.first = node.first, lower.count = half - node.first;
  upper.first = half, upper.count = node.first + node.count - half;
  find_reach(lower), find_reach(upper);
  nodes_.push_back(lower), nodes_.push_back(upper);
  nodes_[number].child = child;
  for (const uint32_t below : {child, child + 1}) {
    build(below, (split.axis + 1) % 3, depth - 1);
    nodes_[number].most_opacity = std::max(nodes_[number].most_opacity, nodes_[below].most_opacity);
  }
}

ParticleTree::ParticleTree(std::span<const Sphere> spheres, const ParticleSettings& settings)
    : spheres_(spheres), settings_(settings), order_(spheres.size()) {
  ParticleNode root;
  root.count = uint32_t(spheres.size());
  for (uint32_t i = 0; i < spheres.size(); i++) order_[i] = i;
  find_reach(root);
  root.box = root.reach;
  nodes_.push_back(root);
  build(0, 0, settings_.depth);
}

// Compares pairs of nodes as figure 8 of the paper does.
class ParticleTree::Culler {
 public:
  Culler(const ParticleTree& tree, const dvec3& eye, float threshold)
      : tree_(tree), eye_(eye), threshold_(threshold), states_(tree.nodes().size()) {}

  std::vector<ParticleState> cull() {
    find_occluders(0);
    return std::move(states_);
  }

 private:
  const ParticleNode& node(uint32_t number) const { return tree_.nodes()[number]; }
  static DoubleBox wide(const Box& box) { return {dvec3(box.low), dvec3(box.high)}; }

  void find_occluders(uint32_t number) {
    if (node(number).most_opacity < threshold_) return;
    if (node(number).opacity >= threshold_) return occlude(number, 0);
    for (uint32_t i = 0; i < 2 && node(number).child; i++) find_occluders(node(number).child + i);
  }

  bool is_below(uint32_t number, uint32_t above) const {
    // Children come after their parents, and spheres of a node lie side by side.
    const ParticleNode &a = node(number), &b = node(above);
    return number > above && a.first >= b.first && a.first + a.count <= b.first + b.count;
  }

  // Tests a potentially occluded node (PON) against an occluder (ON).
  void occlude(uint32_t occluder, uint32_t other) {
    if (node(other).count == 0 || states_[other] == ParticleState::occluded) return;
    if (other == occluder) {
      // Parts of an opaque node hide each other if they are as opaque.
      const uint32_t child = node(other).child;
      if (child == 0) return;
      for (uint32_t i = 0; i < 2; i++)
        if (node(child + i).opacity >= threshold_) occlude(child + i, other);
      return;
    }
    if (is_below(other, occluder)) {
      const uint32_t child = node(occluder).child;
      for (uint32_t i = 0; i < 2; i++)
        if (node(child + i).opacity >= threshold_) occlude(child + i, other);
      return;
    }
    if (!is_below(occluder, other) && states_[other] == ParticleState::visible &&
        BoxShadow(eye_, wide(node(occluder).box)).hides(wide(node(other).reach))) {
      hide(other);
      return;
    }
    if (node(other).child == 0) return;
    for (uint32_t i = 0; i < 2; i++) occlude(occluder, node(other).child + i);
    join(other);
  }

  void hide(uint32_t number) {
    states_[number] = ParticleState::occluded;
    for (uint32_t i = 0; i < 2 && node(number).child; i++) hide(node(number).child + i);
  }

  // Empty children have no say.
  void join(uint32_t number) {
    const uint32_t child = node(number).child;
    const auto state = [&](uint32_t i, uint32_t other) {
      return states_[node(i).count > 0 ? i : other];
    };
    const ParticleState lower = state(child, child + 1), upper = state(child + 1, child);
    states_[number] = lower == upper ? lower : ParticleState::partial;
  }

  const ParticleTree& tree_;
  const dvec3 eye_;
  const float threshold_;
  std::vector<ParticleState> states_;
};

std::vector<ParticleState> ParticleTree::cull(const dvec3& eye, float threshold) const {
  return Culler(*this, eye, threshold).cull();
}

}  // namespace wellspring::scan
