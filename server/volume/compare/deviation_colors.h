// SPDX-License-Identifier: Apache-2.0
// Shows deviations as colours (Malik, Heinzl, Gröller, WSCG 2011, section 3.1, figures 4 and 6).
#pragma once
#include <string>
#include <vector>

#include "volume/compare/cone_search.h"

namespace wellspring::volume {

enum class Shown { distance, normal_angle };

struct ColorTick {
  double value = 0;     // in the scale's unit
  double position = 0;  // 0 at the scale's low end, 1 at its high end
};

// A scale: values from `low` to `high` have the colours of the whole range, others those of its
// ends.
struct ColorScale {
  Shown shown = Shown::distance;
  double low = -1, high = 1;  // millimetres, or degrees
  std::string unit = "mm";
  std::vector<ColorTick> ticks;  // round values, 4 to 11 of them
};

// Returns the scale of distances from -range to range, in mm. `range` must be above 0.
ColorScale distance_scale(double range_mm);
// Returns the scale of angles from 0 to `range` degrees; the paper's is 45.
ColorScale angle_scale(double range_degrees);

// Returns a value's colour, linear RGB. Distances: blue (outside, negative) to white (0) to yellow
// (inside, material is missing), as the discs of glyphs; angles: dark blue to yellow. Both get
// lighter or darker steadily, for eyes that see few colours.
vec3 scale_color(const ColorScale& scale, double value);

// Returns a colour, linear RGB, for each deviation; grey where nothing was found.
std::vector<vec3> deviation_colors(const ColorScale& scale,
                                   const std::vector<Deviation>& deviations);

}  // namespace wellspring::volume
