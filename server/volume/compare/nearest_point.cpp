// SPDX-License-Identifier: Apache-2.0
#include "volume/compare/nearest_point.h"

#include <algorithm>
#include <limits>

namespace wellspring::volume {

PointTree::PointTree(std::vector<dvec3> points) : points_(std::move(points)) {
  build(0, points_.size(), 0);
}

void PointTree::build(size_t begin, size_t end, int axis) {
  if (end - begin < 2) return;
  const size_t middle = begin + (end - begin) / 2;
  const auto at = [&](size_t i) { return points_.begin() + ptrdiff_t(i); };
  std::nth_element(at(begin), at(middle), at(end),
                   [axis](const dvec3& a, const dvec3& b) { return a[axis] < b[axis]; });
  build(begin, middle, (axis + 1) % 3);
  build(middle + 1, end, (axis + 1) % 3);
}

size_t PointTree::nearest(dvec3 to) const {
  size_t best = 0;
  double distance = std::numeric_limits<double>::infinity();
  look(0, points_.size(), 0, to, best, distance);
  return best;
}

void PointTree::look(size_t begin, size_t end, int axis, dvec3 to, size_t& best,
                     double& distance) const {
  if (begin >= end) return;
  const size_t middle = begin + (end - begin) / 2;
  const dvec3 way = to - points_[middle];
  if (const double here = glm::dot(way, way); here < distance) distance = here, best = middle;
  const bool below = way[axis] < 0;
  const int next = (axis + 1) % 3;
  if (below) look(begin, middle, next, to, best, distance);
  else look(middle + 1, end, next, to, best, distance);
  if (way[axis] * way[axis] >= distance) return;
  if (below) look(middle + 1, end, next, to, best, distance);
  else look(begin, middle, next, to, best, distance);
}

}  // namespace wellspring::volume
