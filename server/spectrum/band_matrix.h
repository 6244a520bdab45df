// SPDX-License-Identifier: Apache-2.0
// Surfaces that are known at a few wavelengths, as cameras of many bands see them: a matrix makes
// colours of them under a lamp.
#pragma once
#include <vector>

#include "base/vec.h"
#include "spectrum/spectrum.h"

namespace wellspring::spectrum {

// Returns what a reflectance of 1 in each band adds to X, Y and Z under a lamp; Y of white is 1.
// Between bands reflectances run in straight lines, beyond the first and last band they go on. `nm`
// rises strictly; the lamp must have power that is seen.
std::vector<dvec3> band_matrix(const std::vector<double>& nm, const Spectrum& power);

}  // namespace wellspring::spectrum
