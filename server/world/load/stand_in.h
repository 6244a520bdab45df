// SPDX-License-Identifier: Apache-2.0
// Makes the mesh that rays meet where the eye sees the points of a scan (world/placed_scan.h).
#pragma once
#include <span>

#include "scan/splats/splat_set.h"
#include "scan/tree/node_points.h"
#include "world/scene.h"

namespace wellspring::world {

// A point becomes a square across its normal, so large that a surface closes whose points lie as
// far apart as the node says; a point without a normal becomes three, along the axes. Positions are
// metres relative to the tree's origin; colours are the points', linear. The mesh has material 0
// and Mesh::stands_in.
Mesh make_stand_in(std::span<const NodePoints> nodes);

// Does the same for splats in their file's unit and axes: one of those that hide something becomes
// a rectangle across its thinnest axis; of more than `most` every n-th, so much larger.
Mesh make_stand_in(const SplatSet& splats, size_t most);

}  // namespace wellspring::world
