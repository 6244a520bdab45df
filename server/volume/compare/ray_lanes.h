// SPDX-License-Identifier: Apache-2.0
// Looks for the first boundary along eight lines at once, to both sides of their middles.
#pragma once
#include <vector>

#include "volume/compare/density.h"

namespace wellspring::volume {

// Half a voxel along the line is one step, so that voxels may be longer one way than another.
// Middles and steps are in index.
inline constexpr double steps_per_voxel = 2;
inline constexpr int most_line_steps = 128;

struct LineBatch {
  Lanes3 middle, step;
  Lanes limit{};      // steps from the middle beyond which nothing counts; negative: an unused line
  Lanes threshold{};  // slope per step that a boundary exceeds
};

// Says how long a line's step is, and what counts along it.
struct LineScale {
  vec3 step{0};          // in index
  double metres = 0;     // a step is worth so much
  double threshold = 0;  // slope per step
};
// `ray` is unit, in metres; `slope` is per metre, 0: a tenth of what lies between the two classes
// of densities, per voxel along the line.
LineScale line_scale(const DensityField& field, vec3 ray, double slope);

struct LineHits {
  Lanes offset{};    // steps from the middle, negative against the line's direction
  LaneMask found{};  // all bits where a boundary was found
};

// Derivatives are weighted sums of differences; this many of them are a slope of 1 per step.
inline constexpr float derivative_scale = 6;

// Finds the peak or valley of the slope nearest to the middle; if `falling`, valleys alone.
LineHits first_boundaries(const DensityField& field, const LineBatch& lines, bool falling);

// Returns the slopes per step along the first line at -steps, ..., 0, ..., steps.
std::vector<float> line_slopes(const DensityField& field, const LineBatch& lines, int steps);

}  // namespace wellspring::volume
