// SPDX-License-Identifier: Apache-2.0
// From points to a picture (Walter 1999, section 3.1, and what twenty years added): sharp
// reflectance and highlights from the points themselves, smooth light filtered as widely as it is
// noisy, holes filled at several scales, nothing blended across objects or creases.
#pragma once
#include "cache/cells.h"
#include "cache/point_cache.h"
#include "cache/point_image.h"
#include "cache/still_image.h"
#include "cache/surface_image.h"
#include "frame/frame.h"

namespace wellspring {

// Gives every pixel without a point a surface: from its 3x3 neighbours (weights 2 and 1 for
// reflectance, the nearest for the rest; those of the object with most weight), else from the cells
// around. `known`: what fill_cells() said.
void fill_holes(const View& view, const PointImage& image, const Cells& cells, bool known,
                SurfaceImage& surface, Frame& frame);

// Puts light together: overwrites frame.color, .confidence and, for points at infinity, .depth.
void compose(const View& view, const PointCache& points, const PointImage& image,
             const SurfaceImage& surface, const Cells& cells, Frame& frame);

// Averages what fresh pixels show into `still` and shows the average. Pixels of moving points start
// over.
void accumulate_still(const PointCache& points, const PointImage& image, uint32_t seed,
                      StillImage& still, Frame& frame);

}  // namespace wellspring
