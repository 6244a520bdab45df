// SPDX-License-Identifier: Apache-2.0
// Describes the camera of one picture of points: where, which way, how wide.
#pragma once
#include <optional>

#include "base/vec.h"

namespace wellspring::scan {

// Pixel (0, 0) is the top left one. Places are in the tree's frame, relative to its origin.
struct PointView {
  dvec3 eye{0};
  vec3 right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};  // orthonormal
  float tan_half_fov = 0.5f;  // half of the picture's height at a depth of 1
  int width = 1, height = 1;  // at most most_side
  static constexpr int most_side = 16384;
  // Pixels from the top left to where the axis (`forward`) meets the picture; none: its middle.
  std::optional<vec2> axis;
  float near = 0;     // depth along the axis from which on points are seen
  vec2 offset{0.5f};  // sampling place in each pixel, 0 to 1

  float focal() const { return 0.5f * float(height) / tan_half_fov; }  // in pixels
  vec2 axis_place() const { return axis ? *axis : vec2(0.5f * float(width), 0.5f * float(height)); }
};

}  // namespace wellspring::scan
