// SPDX-License-Identifier: Apache-2.0
// Closes gaps between points of a surface, through which a picture shows what is behind.
#pragma once
#include <span>

#include "scan/draw/point_buffer.h"
#include "scan/camera.h"
#include "scan/tree/node_points.h"

namespace wellspring::scan {

// A pixel is a hole if in three of four directions (rows, columns, both diagonals) nearer pixels of
// one surface lie on both sides of it, no farther from one another than the gaps that points at
// their node's spacing leave. So pixels beside a silhouette, whose nearer neighbours lie on one
// side only, stay, and so do openings wider than the gaps. A hole gets the depth between its
// nearest two neighbours, their mean colour, and the rest of the nearer one. `nodes` and `view` are
// those that were drawn. Pixels are judged by the picture before the call.
void fill_holes(PointBuffer& buffer, std::span<const NodePoints> nodes, const ScanCamera& view);

}  // namespace wellspring::scan
