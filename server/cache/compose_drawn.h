// SPDX-License-Identifier: Apache-2.0
// A picture drawn anew every frame (light/see_picture.h) in light that points remember at half its
// resolution: while the visitor moves, shapes and reflectances are what has to be sharp, light is smoother
// than both, and a quarter of the points tells it sooner.
#pragma once
#include "cache/cells.h"
#include "frame/frame.h"
#include "light/see_picture.h"

namespace wellspring {

inline constexpr int light_scale = 2;  // pixels of the picture a side of one pixel of its light

// The view of the light: its pixels are light_scale pixels of the picture wide.
View light_view(const View& view);

enum class DrawnPlanes { all, color };

// Overwrites all planes of `frame`, or its colours alone: half the memory to write, which is what
// takes long. `light`: of light_view(view), its planes packed as read_surface()
// leaves them, with `cells` filled from it; `known`: what fill_cells() said.
void compose_drawn(const View& view, const PictureSight& sight, const Cells& cells, bool known,
                   const Frame& light, DrawnPlanes planes, Frame& frame);

}  // namespace wellspring
