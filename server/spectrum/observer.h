// SPDX-License-Identifier: Apache-2.0
// The standard observer of CIE 1931 (2 degrees): X, Y and Z of light, and of surfaces under a lamp.
#pragma once
#include <vector>

#include "base/vec.h"
#include "spectrum/spectrum.h"

namespace wellspring::spectrum {

// Returns the observer's three responses to a unit of power at 360, 361 ... 830 nm.
const std::array<dvec3, spectrum_size>& matching_functions();

// Returns X, Y and Z of power over wavelength, in the unit of the power.
dvec3 xyz_of(const Spectrum& power);

// Sees surfaces under one lamp; Y of a white one is 1. The lamp must have power that is seen.
class LampObserver {
 public:
  explicit LampObserver(const Spectrum& power);
  // Returns X, Y and Z of light that is sent back once.
  dvec3 xyz(const Spectrum& reflectance) const;
  const dvec3& white() const { return white_; }
  // Returns what each nanometre adds to X, Y and Z of a white surface.
  const std::array<dvec3, spectrum_size>& weights() const { return weights_; }

 private:
  std::array<dvec3, spectrum_size> weights_;
  dvec3 white_{0};
};

}  // namespace wellspring::spectrum
