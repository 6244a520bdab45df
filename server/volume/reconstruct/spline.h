// SPDX-License-Identifier: Apache-2.0
// Tricubic B-splines over a grid, and gradients of them (Csébfalvi and Domonkos, Prefiltered
// Gradient Reconstruction for Volume Rendering). Pictures take Spline<float>; in double, the same
// code shows what the schemes are worth.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "volume/reconstruct/sample_box.h"
#include "volume/volume.h"

namespace wellspring::volume {

// Says how gradients are found (section 4); b is the cubic B-spline, b' its derivative, p, c and d
// are filters of line_filter.h. An order counts by which power of the distance of samples an error
// falls.
enum class GradientScheme {
  central,      // c * b, order 2: for comparison. Takes three more grids.
  wide,         // d * b, order 4: sharp, mild to noise. Takes three more grids.
  analytic,     // b', order 2: soft, mild to noise
  prefiltered,  // p * b', order 3: sharpest; shows the steps of coarsely rounded samples
  // The paper counts orders along one axis. In space, c * b, d * b and b' are of order 2, since b
  // blurs across the derivative, too. These two are not the paper's:
  wide_across,   // d along the derivative, p across it, then b: order 4 in space
  interpolating  // b' of the spline that meets the samples, order 3
};

// A grid's spline. Its values are f * b, of order 2; with `prefiltered` and `wide_across` they are
// f * p * b, of order 4 (section 3); with `interpolating` they meet the samples, of order 4.
template <class Real>
struct Spline {
  glm::ivec3 size{0};
  GradientScheme scheme = GradientScheme::prefiltered;
  // Coefficients, x fastest, with one more before the first of each axis and one or two after the
  // last, from the mirrors that stand in the border's samples.
  glm::ivec3 padded{0};
  std::vector<Real> coefficients;
  // The same of derivatives along x, y and z: of `central`, `wide` and `wide_across`.
  std::array<std::vector<Real>, 3> derivatives;
};

// Returns the spline of samples, x fastest; they are finite. Throws std::invalid_argument if there
// are none, or not size.x * size.y * size.z, and std::length_error if they are too many for one
// spline: 2^31 with the padding.
template <class Real>
Spline<Real> make_spline(std::span<const Real> samples, glm::ivec3 size, GradientScheme scheme);
inline Spline<float> make_spline(const Grid& grid, GradientScheme scheme) {
  return make_spline<float>(grid.values, grid.size, scheme);
}

template <class Real>
struct ValueGradient {
  Real value = 0;
  glm::vec<3, Real> gradient{0};  // per sample
};
struct LanesGradient {
  Lanes value;
  Lanes3 gradient;
};

// Return what lies at a place, an index (see SampleBox for those outside). The gradient across a
// border's samples is 0 there, as the mirror wants it.
template <class Real>
Real value_at(const Spline<Real>& spline, glm::vec<3, Real> place);
template <class Real>
ValueGradient<Real> gradient_at(const Spline<Real>& spline, glm::vec<3, Real> place);
// Eight places at a time.
Lanes value_at(const Spline<float>& spline, const Lanes3& place);
LanesGradient gradient_at(const Spline<float>& spline, const Lanes3& place);

// The same of coefficients that lie anywhere, such as bricks with a skirt: one coefficient before
// and after the box's along each axis can be read, two after an axis of one. `first` is added to
// the index of each lane's coefficients.
Lanes spline_value(const SampleBox<float>& box, const Lanes3& place,
                   const LaneMask& first = LaneMask{});
LanesGradient spline_gradient(const SampleBox<float>& box, const Lanes3& place,
                              const LaneMask& first = LaneMask{});

}  // namespace wellspring::volume
