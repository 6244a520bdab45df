// SPDX-License-Identifier: Apache-2.0
// Says from where, and which way, a picture of scanned things is made.
#pragma once
#include <optional>
#include <vector>

#include "base/vec.h"

namespace wellspring::scan {

// Keeps what lies on one side of a plane: places where dot(normal, place) >= offset.
struct ScanCut {
  vec3 normal{0};    // unit
  float offset = 0;  // metres
  bool operator==(const ScanCut&) const = default;
};

// Holds a camera with orthonormal axes. Rows of the picture go from the top; a place at `depth`
// metres along `forward` and `x` metres to the right lies focal() * x / depth pixels right of
// axis_place().
struct ScanCamera {
  dvec3 eye{0};  // metres, in the frame of what is drawn
  vec3 right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};
  float tan_half_fov = 0.5f;  // half of the picture's height at a depth of 1
  int width = 1, height = 1;
  // `forward` meets the picture here, pixels from the top left; none: in its middle.
  std::optional<vec2> axis;
  float near = 0;     // metres along `forward` before which nothing is shown
  vec2 offset{0.5f};  // pixels are sampled here, 0 to 1 from their top left
  // Points are shown only where all of these keep them; in the frame of what is drawn.
  std::vector<ScanCut> cuts;
  vec2 axis_place() const { return axis ? *axis : vec2(0.5f * float(width), 0.5f * float(height)); }
  float focal() const { return 0.5f * float(height) / tan_half_fov; }  // in pixels
};

}  // namespace wellspring::scan
