// SPDX-License-Identifier: Apache-2.0
// Fits rigid moves.
#pragma once
#include <array>
#include <vector>

#include "base/vec.h"

namespace wellspring::volume {

// Turns a symmetric matrix into its eigenvectors, as columns, and eigenvalues, largest first, by
// Jacobi's rotations.
template <size_t Size>
struct SymmetricMatrix {
  std::array<std::array<double, Size>, Size> at{};
};
template <size_t Size>
struct Eigenvectors {
  std::array<double, Size> values{};
  std::array<std::array<double, Size>, Size> vectors{};  // vectors[i] belongs to values[i]
};
Eigenvectors<3> eigenvectors(const SymmetricMatrix<3>& matrix);
Eigenvectors<4> eigenvectors(const SymmetricMatrix<4>& matrix);

// Returns the rigid move that leads `from[i]` to `to[i]` with the least sum of squares (Horn 1987,
// by quaternions). Both have as many points, at least 3.
dmat4 fit_points(const std::vector<dvec3>& from, const std::vector<dvec3>& to);

// One point near a plane: how far it is, and the plane's normal.
struct PlaneGap {
  dvec3 point{0}, normal{0};
  double gap = 0;  // along the normal, from the plane to the point
};

// Returns the small rigid move that lays the points on their planes with the least sum of squares
// (Chen and Medioni 1992). Moves that no plane holds are not made.
dmat4 fit_planes(const std::vector<PlaneGap>& gaps);

}  // namespace wellspring::volume
