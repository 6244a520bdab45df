// SPDX-License-Identifier: Apache-2.0
// Draws what a visitor's glass shows. The tick decides when (show/draw/decide.h), and calls
// begin_lens(), the renderer draw_lens(), the tick finish_lens().
#pragma once
#include "show/state/renderer.h"
#include "show/state/show.h"

namespace wellspring::show {

inline constexpr float lens_sides = 3;  // radii a side: half a radius is margin on each

// Returns the view that the glass's picture has: a square around its middle, of so many radii,
// whose content is `zoom` times as large as in `view`.
View lens_view(const View& view, const LensOrder& order, float zoom, float sides = lens_sides);
// Returns the ray of the eye through its middle.
Ray lens_ray(const View& view, const LensOrder& order);
// Returns the zoom of an order: where it is 0, texels of the very large picture under the glass's
// middle become pixels.
float zoom_of(const World& world, const View& view, const LensOrder& order);
// Returns whether the visitor moves a glass, or has just done so.
bool moves_lens(double time, const Visitor& visitor);
// Returns whether the visitor's glass is to be drawn.
bool lens_is_due(const Show& show, const Visitor& visitor);

// Puts the world into the state that the glass shows. Only while the renderer is idle.
void begin_lens(Show& show, Visitor& visitor);
void draw_lens(Show& show, Visitor& visitor);
void finish_lens(Show& show, Visitor& visitor);

}  // namespace wellspring::show
