// SPDX-License-Identifier: Apache-2.0
// Takes the spectra of places of a picture of many bands.
#pragma once
#include <cstdint>
#include <vector>

#include "store/band_files/band_source.h"

namespace wellspring::store {

// Holds the means of a square of `side` texels around (x, y), from the upper left, for each band.
struct BandPlace {
  int64_t x = 0, y = 0;
  std::vector<double> reflectances;
};

// Returns at most `most` places on an even grid. Throws LoadError.
std::vector<BandPlace> sample_places(const BandSource& source, int most, int side = 3);

}  // namespace wellspring::store
