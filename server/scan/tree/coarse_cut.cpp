// SPDX-License-Identifier: Apache-2.0
#include "scan/tree/coarse_cut.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace wellspring::scan {

std::vector<NodePoints> coarse_cut(const PointTree& tree, size_t most_points) {
  auto finer = [&](uint32_t a, uint32_t b) {
    const TreeNode &one = tree.nodes[a], &other = tree.nodes[b];
    return one.spacing != other.spacing ? one.spacing < other.spacing : a > b;
  };
  std::priority_queue<uint32_t, std::vector<uint32_t>, decltype(finer)> open(finer);
  std::vector<NodePoints> cut;
  if (tree.nodes.empty()) return cut;
  open.push(0);
  size_t points = tree.nodes[0].count;
  while (!open.empty()) {
    const uint32_t number = open.top();
    open.pop();
    const TreeNode& node = tree.nodes[number];
    size_t instead = 0;
    for (uint32_t i = 0; i < node.children; i++) instead += tree.nodes[node.first_child + i].count;
    if (node.is_leaf() || points - node.count + instead > most_points) {
      cut.push_back(tree.points_of(number));
      continue;
    }
    points += instead - node.count;
    for (uint32_t i = 0; i < node.children; i++) open.push(node.first_child + i);
  }
  return cut;
}

PointBounds bounds_of(const std::vector<NodePoints>& nodes) {
  PointBounds bounds{dvec3(INFINITY), dvec3(-INFINITY)};
  for (const NodePoints& node : nodes) {
    const uint16_t* columns[3] = {node.x, node.y, node.z};
    for (int axis = 0; axis < 3 && node.count > 0; axis++) {
      const auto [least, most] = std::minmax_element(columns[axis], columns[axis] + node.count);
      const double step = double(node.size) / 65536;
      bounds.low[axis] = std::min(bounds.low[axis], node.corner[axis] + (*least + 0.5) * step);
      bounds.high[axis] = std::max(bounds.high[axis], node.corner[axis] + (*most + 0.5) * step);
    }
  }
  if (!(bounds.low.x <= bounds.high.x)) return {};
  return bounds;
}

}  // namespace wellspring::scan
