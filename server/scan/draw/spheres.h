// SPDX-License-Identifier: Apache-2.0
// Nodes whose points are opaque spheres (paper on large particle sets, section 5).
#pragma once
#include "scan/draw/disc_style.h"
#include "scan/tree/point_tree.h"

namespace wellspring::scan {

// Returns the points of a node, spaced so that a style with `spheres` draws them of this radius,
// metres. Those of inner nodes stand for several each, and cover as much as these would side by
// side, but no more than what their spacing leaves.
NodePoints spheres_of(const PointTree& tree, uint32_t node, float radius, const DiscStyle& style);

}  // namespace wellspring::scan
