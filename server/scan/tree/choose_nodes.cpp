// SPDX-License-Identifier: Apache-2.0
#include "scan/tree/choose_nodes.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <vector>

#include "scan/tree/box_shadow.h"

namespace wellspring::scan {
namespace {

// So many boxes are asked whether they hide others, those that look largest: what small ones hide
// costs less than asking them.
constexpr size_t most_occluders = 128;
constexpr double least_occluder_pixels = 24;
constexpr double nearest = 0.05;  // metres: what lies nearer counts as if it lay there

DoubleBox box_of(const TreeNode& node) {
  return {node.corner, node.corner + dvec3(double(node.size))};
}

double distance_to(const dvec3& eye, const DoubleBox& box) {
  return glm::length(glm::max(glm::max(box.low - eye, eye - box.high), dvec3(0)));
}

// The planes of what a view sees, and those that cut it; they need not be of unit length.
class Frustum {
 public:
  explicit Frustum(const ScanCamera& view) {
    const dvec3 right(view.right), up(view.up), forward(view.forward);
    const double focal = double(view.focal());
    const dvec2 axis(view.axis_place()), size(view.width, view.height);
    planes_.push_back({forward, -glm::dot(forward, view.eye) - double(view.near)});
    const auto add = [&](const dvec3& normal) {
      planes_.push_back({normal, -glm::dot(normal, view.eye)});
    };
    add(forward * (axis.x / focal) + right), add(forward * ((size.x - axis.x) / focal) - right);
    add(forward * ((size.y - axis.y) / focal) + up), add(forward * (axis.y / focal) - up);
    for (const ScanCut& cut : view.cuts)
      planes_.push_back({dvec3(cut.normal), -double(cut.offset)});
  }
  // Returns false if the box lies beyond one plane.
  bool touches(const DoubleBox& box) const {
    const dvec3 centre = (box.low + box.high) / 2.0, half = (box.high - box.low) / 2.0;
    for (const Plane& plane : planes_)
      if (glm::dot(plane.normal, centre) + plane.offset < -glm::dot(glm::abs(plane.normal), half))
        return false;
    return true;
  }

 private:
  struct Plane {
    dvec3 normal;
    double offset;
  };
  std::vector<Plane> planes_;
};

struct Occluder {
  BoxShadow shadow;
  DoubleBox box;
  double distance;
};

bool is_disjoint(const DoubleBox& a, const DoubleBox& b) {
  for (int axis = 0; axis < 3; axis++)
    if (a.low[axis] >= b.high[axis] || a.high[axis] <= b.low[axis]) return true;
  return false;
}

class Chooser {
 public:
  Chooser(const PointTree& tree, const ScanCamera& view, const ChooseSettings& settings)
      : tree_(tree), view_(view), settings_(settings), frustum_(view) {
    pixels_a_metre_ = double(view.focal());
  }

  ChosenNodes choose() {
    // Nobody knows whether a node that is cut hides anything.
    if (settings_.threshold < 1 && view_.cuts.empty()) find_occluders();
    if (frustum_.touches(box_of(tree_.nodes[0])) && !is_hidden(0)) push(0);
    ChosenNodes chosen;
    chosen.points = points_;
    while (!heap_.empty()) {
      const Candidate candidate = heap_.top();
      const TreeNode& node = tree_.nodes[candidate.node];
      if (node.is_leaf()) {
        heap_.pop();
        done_.push_back(candidate);
        continue;
      }
      if (candidate.pixels <= settings_.pixels || !refine(node)) break;
    }
    for (; !heap_.empty(); heap_.pop()) done_.push_back(heap_.top());
    std::ranges::sort(done_, [](const Candidate& a, const Candidate& b) {
      return a.distance != b.distance ? a.distance < b.distance : a.node < b.node;
    });
    for (const Candidate& candidate : done_)
      chosen.nodes.push_back({candidate.node, candidate.pixels});
    chosen.points = points_, chosen.hidden = hidden_;
    return chosen;
  }

 private:
  struct Candidate {
    float pixels;
    uint32_t node;
    double distance;
    bool operator<(const Candidate& other) const {
      return pixels != other.pixels ? pixels < other.pixels : node > other.node;
    }
  };

  Candidate candidate_of(uint32_t number) const {
    const TreeNode& node = tree_.nodes[number];
    const double distance = distance_to(view_.eye, box_of(node));
    const double shown = std::max(distance, std::max(double(view_.near), nearest));
    return {float(node.spacing * pixels_a_metre_ / shown), number, distance};
  }

  void push(uint32_t number) {
    heap_.push(candidate_of(number));
    points_ += tree_.nodes[number].count;
  }

  // Puts the node's children in its place; false: they are too many. The node is the heap's first.
  bool refine(const TreeNode& node) {
    uint32_t seen[8];
    int count = 0;
    uint64_t points = points_ - node.count, hidden = 0;
    for (uint32_t i = 0; i < node.children; i++) {
      const uint32_t child = node.first_child + i;
      if (!frustum_.touches(box_of(tree_.nodes[child]))) continue;
      if (is_hidden(child)) {
        hidden += tree_.nodes[child].count;
        continue;
      }
      seen[count++] = child;
      points += tree_.nodes[child].count;
    }
    if (points > settings_.budget && points > points_) return false;
    heap_.pop();
    points_ -= node.count, hidden_ += hidden;
    for (int i = 0; i < count; i++) push(seen[i]);
    return true;
  }

  bool is_hidden(uint32_t number) const {
    const DoubleBox box = box_of(tree_.nodes[number]);
    const double distance = distance_to(view_.eye, box);
    for (const Occluder& occluder : occluders_) {
      if (occluder.distance > distance) break;
      if (occluder.shadow.hides(box) && is_disjoint(occluder.box, box)) return true;
    }
    return false;
  }

  // Opaque nodes, also those in others that are: children of an opaque one hide each other.
  void find_occluders() {
    std::vector<std::pair<double, uint32_t>> found;
    std::vector<uint32_t> open{0};
    while (!open.empty()) {
      const uint32_t number = open.back();
      open.pop_back();
      const TreeNode& node = tree_.nodes[number];
      const DoubleBox box = box_of(node);
      if (!frustum_.touches(box)) continue;
      const double distance = distance_to(view_.eye, box);
      const double pixels =
          node.size * pixels_a_metre_ / std::max(distance, std::max(double(view_.near), nearest));
      if (pixels < least_occluder_pixels) continue;
      if (node.opacity >= settings_.threshold && distance > 0) found.emplace_back(pixels, number);
      for (uint32_t i = 0; i < node.children; i++) open.push_back(node.first_child + i);
    }
    std::ranges::sort(found, std::greater());
    if (found.size() > most_occluders) found.resize(most_occluders);
    for (const auto& [pixels, number] : found) {
      const DoubleBox box = box_of(tree_.nodes[number]);
      occluders_.push_back({BoxShadow(view_.eye, box), box, distance_to(view_.eye, box)});
    }
    std::ranges::sort(occluders_, {}, &Occluder::distance);
  }

  const PointTree& tree_;
  const ScanCamera& view_;
  const ChooseSettings& settings_;
  const Frustum frustum_;
  double pixels_a_metre_ = 1;
  std::vector<Occluder> occluders_;
  std::priority_queue<Candidate> heap_;
  std::vector<Candidate> done_;
  uint64_t points_ = 0, hidden_ = 0;
};

}  // namespace

ChosenNodes choose_nodes(const PointTree& tree, const ScanCamera& view,
                         const ChooseSettings& settings) {
  return Chooser(tree, view, settings).choose();
}

}  // namespace wellspring::scan
