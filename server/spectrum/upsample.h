// SPDX-License-Identifier: Apache-2.0
// A smooth reflectance for a colour of which only red, green and blue are known: a sigmoid of a
// quadratic polynomial of the wavelength, which lies between 0 and 1 by itself (Jakob and Hanika
// 2019). It has the colour under D65 and is a guess under all other lamps.
#pragma once
#include "base/vec.h"
#include "spectrum/spectrum.h"

namespace wellspring::spectrum {

// Holds the coefficients of (nm - 360) / 470 squared, of itself, and the constant one.
struct SmoothReflectance {
  dvec3 coefficients{0};
  double at(double nm) const;
};

// Returns the reflectance of a linear Rec. 709 colour, whose channels are cut to 0 to 1. Takes
// some tens of microseconds, so it is for colours that are read once.
SmoothReflectance fit_reflectance(const dvec3& rgb);
Spectrum sample_reflectance(const SmoothReflectance& reflectance);

}  // namespace wellspring::spectrum
