// SPDX-License-Identifier: Apache-2.0
// A window of a view's picture.
#pragma once
#include "world/view.h"

namespace wellspring::cache {

// Pixels of a picture, from (left, top) on.
struct PictureWindow {
  int left = 0, top = 0, width = 0, height = 0;
  bool empty() const { return width <= 0 || height <= 0; }
};

// What a window of a view's picture shows, as a picture of its own: the middle of that may lie off
// the axis.
struct WindowView : View {
  vec2 shift{0};  // pixels that it lies to the right and below
  WindowView(const View& view) : View(view) {}
  WindowView(const View& view, const PictureWindow& window) : View(view) {
    width = window.width, height = window.height;
    tan_half_fov = view.tan_half_fov * float(height) / float(view.height);
    shift = vec2(float(window.left) + 0.5f * float(width - view.width),
                 float(window.top) + 0.5f * float(height - view.height));
  }
};

}  // namespace wellspring::cache
