// SPDX-License-Identifier: Apache-2.0
// Weights of the four coefficients next to a place, and their slopes: the cubic B-spline (Csébfalvi
// and Domonkos, Prefiltered Gradient Reconstruction for Volume Rendering, equation 7).
#pragma once
#include <array>

#include "base/layers.h"

namespace wellspring::volume {

// `way` is 0 at the second coefficient and 1 at the third: a Real, or lanes of them.
template <class Real, class Number>
inline std::array<Number, 4> spline_weights(const Number& way) {
  const Number back = Real(1) - way, square = way * way, back_square = back * back;
  return {back_square * back * Real(1.0 / 6), Real(2.0 / 3) - square * (Real(1) - Real(0.5) * way),
          Real(2.0 / 3) - back_square * (Real(1) - Real(0.5) * back), square * way * Real(1.0 / 6)};
}

// Returns their derivatives with respect to `way`.
template <class Real, class Number>
inline std::array<Number, 4> spline_slopes(const Number& way) {
  const Number back = Real(1) - way;
  return {back * back * Real(-0.5), way * (Real(1.5) * way - Real(2)),
          back * (Real(2) - Real(1.5) * back), way * way * Real(0.5)};
}

}  // namespace wellspring::volume
