// SPDX-License-Identifier: Apache-2.0
// Opacity of a box with spheres in it: the share of lines through the box that hit a sphere there
// ("density" in the paper on large particle sets, section 4.2). Lines are uniform and isotropic:
// they begin anywhere on the box's surface, and their directions inward are distributed by cosine.
// So by Crofton's formula a convex body stops the ratio of its surface to the box's.
#pragma once
#include <cstdint>
#include <span>

#include "base/vec.h"

namespace wellspring::scan {

struct Sphere {
  vec3 place{0};
  float radius = 0;
};

struct Box {
  vec3 low{0}, high{0};
};

// Throws so many lines; the standard error is sqrt(opacity (1 - opacity) / lines). Ends after an
// eighth of them if fewer than `least` of these were stopped, since then nobody asks for more.
float sample_opacity(const Box& box, std::span<const Sphere> spheres, int lines, uint64_t seed,
                     float least = 0);

}  // namespace wellspring::scan
