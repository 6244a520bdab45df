// SPDX-License-Identifier: Apache-2.0
// What light falls on: the pixels of a view, row by row, as a visibility pass or rays found them.
// Borrowed arrays, each of width * height numbers.
#pragma once
#include "light/visible/pixel_grid.h"
#include "world/view.h"

namespace wellspring::light {

struct SplatPixels {
  View view;
  vec2 offset{0.5f};  // of the sampling place in its pixel
  const float* depth =
      nullptr;  // along the viewing axis; infinite, NaN, <= 0: nothing is lit there
  const float *nx = nullptr, *ny = nullptr, *nz = nullptr;  // unit normal, towards the eye
  const vec3* position = nullptr;  // scene coordinates, where known better than by depth; or null
};

inline bool is_lit(const SplatPixels& pixels, size_t i) {
  return pixels.depth[i] > 0 && pixels.depth[i] < std::numeric_limits<float>::infinity();
}
inline PixelGrid make_pixel_grid(const SplatPixels& pixels) {
  return PixelGrid(pixels.view, pixels.offset);
}
inline vec3 place_from_eye(const SplatPixels& pixels, const PixelGrid& grid, int x, int y) {
  size_t i = size_t(y) * size_t(pixels.view.width) + size_t(x);
  if (pixels.position) return pixels.position[i] - pixels.view.position;
  return (grid.corner + grid.right * float(x) + grid.down * float(y)) * pixels.depth[i];
}

}  // namespace wellspring::light
