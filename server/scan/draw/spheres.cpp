// SPDX-License-Identifier: Apache-2.0
#include "scan/draw/spheres.h"

#include <algorithm>
#include <cmath>

namespace wellspring::scan {
namespace {

constexpr float widest = 0.75f;  // radius of a sphere that stands for several, in their spacing

}  // namespace

NodePoints spheres_of(const PointTree& tree, uint32_t node, float radius, const DiscStyle& style) {
  NodePoints points = tree.points_of(node);
  const float share = float(tree.nodes[node].beneath) / float(std::max(points.count, 1u));
  const float together = radius * std::sqrt(std::max(share, 1.0f));
  points.spacing = std::min(together, std::max(radius, widest * points.spacing)) / style.radius;
  return points;
}

}  // namespace wellspring::scan
