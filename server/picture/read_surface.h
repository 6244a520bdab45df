// SPDX-License-Identifier: Apache-2.0
// From the points that a picture shows to its cells and its packed surface, once a picture.
#pragma once
#include "cache/cache_stats.h"
#include "picture/cells.h"
#include "picture/surface_image.h"

namespace wellspring::picture {

// Reads every visible point once: builds the cells, fills holes from their neighbours and leaves
// the surface packed in the frame's planes. Pixels far from any point stay unknown.
ShownPoints read_surface(const WindowView& view, const PointCache& points, const PointImage& image,
                         Cells& cells, Frame& frame);

}  // namespace wellspring::picture
