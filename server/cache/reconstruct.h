// SPDX-License-Identifier: Apache-2.0
// From points to a picture (Walter 1999, section 3.1, and what twenty years added): sharp
// reflectance and highlights from the points themselves, smooth light filtered as widely as it is
// noisy, holes filled at several scales, nothing blended across objects or creases.
#pragma once
#include "cache/cells.h"
#include "cache/point_cache.h"
#include "cache/point_image.h"
#include "cache/surface_image.h"
#include "frame/frame.h"

namespace wellspring {

// What read_surface() saw on its way.
struct SurfaceCounts {
  int64_t points = 0;     // pixels with a point
  int64_t converged = 0;  // pixels whose point holds `converged_samples` or more
};

// Reads every visible point once: builds the cells, fills holes from their neighbours and leaves
// the surface packed in the frame's planes. Pixels far from any point stay unknown.
SurfaceCounts read_surface(const WindowView& view, const PointCache& points,
                           const PointImage& image, Cells& cells, Frame& frame);

// Fills what is still unknown from the cells around and puts light together: overwrites all planes
// of the frame. `known`: what fill_cells() said.
void compose(const View& view, const Cells& cells, bool known, Frame& frame);

}  // namespace wellspring
