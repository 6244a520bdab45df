// SPDX-License-Identifier: Apache-2.0
// Where a view's pixels lie, at a depth of 1.
#pragma once
#include "world/view.h"

namespace wellspring::light {

// From the eye: the sampling place of pixel (x, y), `offset` into it, lies at
// view.position + depth * at(x, y).
struct PixelGrid {
  vec3 corner, right, down;
  explicit PixelGrid(const View& view, vec2 offset = vec2(0.5f)) {
    const float size = 2 * view.tan_half_fov / float(view.height);
    const vec2 axis = axis_place(view);
    right = view.right * size;
    down = view.up * -size;
    corner = view.forward + right * (offset.x - axis.x) + down * (offset.y - axis.y);
  }
  vec3 at(float x, float y) const { return corner + right * x + down * y; }
};

}  // namespace wellspring::light
