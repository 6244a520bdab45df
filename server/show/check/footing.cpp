// SPDX-License-Identifier: Apache-2.0
#include "show/check/footing.h"

#include <algorithm>
#include <vector>

#include "scan/tree/point_tree.h"
#include "world/placed_scan.h"

namespace wellspring::show {
namespace {

// Holds an upright column in a tree's frame, metres of its own.
struct Column {
  dvec3 middle;
  double radius, reach;
  bool touches(const TreeNode& node) const {
    const dvec3 high = node.corner + dvec3(double(node.size));
    return holds(glm::clamp(middle, node.corner, high));
  }
  bool holds(dvec3 point) const {
    return std::hypot(point.x - middle.x, point.z - middle.z) <= radius &&
           std::abs(point.y - middle.y) <= reach;
  }
};

// Adds the heights of the points of all leaves below a node that the column holds.
void gather_heights(const PointTree& tree, uint32_t number, const Column& column,
                    std::vector<double>& heights) {
  const TreeNode& node = tree.nodes[number];
  if (!column.touches(node)) return;
  for (uint32_t i = 0; i < node.children; i++)
    gather_heights(tree, node.first_child + i, column, heights);
  if (!node.is_leaf()) return;
  const NodePoints points = tree.points_of(number);
  const double step = double(points.size) / 65536;
  for (uint32_t i = 0; i < points.count; i++) {
    const dvec3 at =
        points.corner + step * (dvec3(points.x[i], points.y[i], points.z[i]) + dvec3(0.5));
    if (column.holds(at)) heights.push_back(at.y);
  }
}

std::optional<float> scanned_footing(const PlacedScan& scan, vec3 feet, float radius) {
  if (scan.sets.empty() || scan.sets[0].points->nodes.empty()) return {};
  const ScanSet& set = scan.sets[0];  // feet stand on the first of several times
  const glm::dquat back = glm::conjugate(glm::dquat(scan.turn));
  const double scale(scan.scale);
  const Column column{back * dvec3(feet - scan.position) / scale - set.offset,
                      double(radius) / scale, double(foot_reach) / scale};
  std::vector<double> heights;
  gather_heights(*set.points, 0, column, heights);
  if (heights.empty()) return {};
  const auto middle = heights.begin() + std::ptrdiff_t(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  return feet.y + float(scale * (*middle - column.middle.y));
}

}  // namespace

std::optional<float> find_footing(const World& world, vec3 feet, float radius) {
  std::optional<float> found;
  Ray ray{feet + vec3(0, foot_reach, 0), 0, {0, -1, 0}, 2 * foot_reach};
  ray.from_eye = !world.scans().empty();  // so that it passes what stands in for points
  if (const Hit hit = world.intersect(ray); hit.valid() && !world.is_moving(hit.instance))
    found = ray.origin.y - hit.t;
  for (const PlacedScan& scan : world.scans())
    if (const auto height = scanned_footing(scan, feet, radius); height && !(found > height))
      found = height;
  return found;
}

}  // namespace wellspring::show
