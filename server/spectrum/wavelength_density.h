// SPDX-License-Identifier: Apache-2.0
// How densely wavelengths are drawn: as 1 / cosh^2(A (nm - B)), which follows what all three
// responses of an eye need, so that there is less colour noise than by brightness alone
// (Radziszewski, Boryczko, Alda 2009, equation 8). Its integral is a hyperbolic tangent.
#pragma once
#include <cmath>

#include "base/layers.h"

namespace wellspring::spectrum {

class WavelengthDensity {
 public:
  static constexpr double slope = 0.0072, middle_nm = 538;  // A, per nanometre, and B

  WavelengthDensity(double low_nm, double high_nm)
      : low_(std::tanh(slope * (low_nm - middle_nm))),
        high_(std::tanh(slope * (high_nm - middle_nm))) {}

  // Returns the integral of 1 / cosh^2 in nanometres, N of the paper.
  double norm() const { return (high_ - low_) / slope; }
  // Returns the density per nanometre; its integral over the range is 1.
  double at(double nm) const {
    const double c = std::cosh(slope * (nm - middle_nm));
    return 1 / (c * c * norm());
  }
  // Returns the wavelength below which lies a share `u`, 0 to 1, of all that are drawn.
  double quantile(double u) const {
    return middle_nm + std::atanh(low_ + u * (high_ - low_)) / slope;
  }

 private:
  double low_, high_;  // tanh at the ends
};

}  // namespace wellspring::spectrum
