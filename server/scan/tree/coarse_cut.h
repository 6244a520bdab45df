// SPDX-License-Identifier: Apache-2.0
// Stands for a whole tree of points by a bounded number of them.
#pragma once
#include <cstddef>
#include <vector>

#include "scan/tree/node_points.h"
#include "scan/tree/point_tree.h"

namespace wellspring::scan {

// Returns the nodes of a cut that has at most so many points, as even in spacing as may be: the
// coarsest node is refined first. The root alone may have more.
std::vector<NodePoints> coarse_cut(const PointTree& tree, size_t most_points);

// Metres in the tree's frame, relative to its origin.
struct PointBounds {
  dvec3 low{0}, high{0};
};
// Returns the bounds of these points; without any both corners are 0.
PointBounds bounds_of(const std::vector<NodePoints>& nodes);

}  // namespace wellspring::scan
