// SPDX-License-Identifier: Apache-2.0
// Filters that run along the lines of a grid, one axis after the other, before it is reconstructed
// (Csébfalvi and Domonkos, Prefiltered Gradient Reconstruction for Volume Rendering). Lines go on
// beyond their ends as in a mirror that stands in the last sample: f(-k) = f(k).
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "base/layers.h"

namespace wellspring::volume {

enum class LineFilter {
  // Gives coefficients whose cubic B-spline is cubic polynomials themselves, and nearly meets the
  // samples of others: p = (-1, 8, -1) / 6 (section 3, equation 10).
  quasi_interpolating,
  // Gives those whose cubic B-spline meets every sample: the way back from (1, 4, 1) / 6, which a
  // recursion there and one back find exactly (Unser, Aldroubi and Eden 1993).
  interpolating,
  // Gives derivatives, per sample: (f(k + 1) - f(k - 1)) / 2, c of section 4, equation 11.
  central_difference,
  // 5/6 (f(k + 1) - f(k - 1)) - 1/6 (f(k + 2) - f(k - 2)): d of section 4, equation 16. It goes
  // beyond the derivative by as much as the B-spline blurs it.
  wide_difference,
};

// Returns which sample of `size` lies at any index, in the mirrors of both ends.
int mirrored(int index, int size);

// Filters a grid, x fastest, along axis 0, 1 or 2. Sums are doubles; a result beyond the largest
// Real becomes that. Values are finite.
template <class Real>
void filter_axis(std::vector<Real>& values, glm::ivec3 size, int axis, LineFilter filter);

}  // namespace wellspring::volume
