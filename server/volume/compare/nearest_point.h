// SPDX-License-Identifier: Apache-2.0
// Finds the nearest of many points.
#pragma once
#include <cstddef>
#include <vector>

#include "base/vec.h"

namespace wellspring::volume {

// A k-d tree (Bentley 1975) without pointers: the middle of each range splits it.
class PointTree {
 public:
  explicit PointTree(std::vector<dvec3> points);
  const std::vector<dvec3>& points() const { return points_; }
  // Returns the index in points() of the nearest; there must be one.
  size_t nearest(dvec3 to) const;

 private:
  void build(size_t begin, size_t end, int axis);
  void look(size_t begin, size_t end, int axis, dvec3 to, size_t& best, double& distance) const;
  std::vector<dvec3> points_;
};

}  // namespace wellspring::volume
