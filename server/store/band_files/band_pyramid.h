// SPDX-License-Identifier: Apache-2.0
// Writes a picture of many bands as `./wellspring import bands` does: a BigTIFF of tiles with
// smaller versions in further pages, bands apart from one another (planar), so that a layer reads
// no other bands than its own, and the description inside.
#pragma once
#include <functional>
#include <string>

#include "store/band_files/band_source.h"

namespace wellspring::store {

// 8 bits hold the square root of the reflectance, in steps that are as fine in the dark as sRGB's;
// 16 bits hold it as it is. Both are cut to 0 to 1.
struct BandPyramidSettings {
  int bits = 8;     // 8 or 16
  int quality = 0;  // JPEG's, 1 to 100, which has 8 bits; 0: Zstandard, no losses
  std::function<void(double)> progress = [](double) {};  // share that is done
};

// Says what was written: of all values of the finest level the share that was cut.
struct BandPyramidStats {
  int levels = 0;
  double above = 0, below = 0;
};

// Writes `file` anew. Throws LoadError of the source, or of `file` if it cannot be written.
BandPyramidStats write_band_pyramid(const BandSource& source, const std::string& file,
                                    const BandPyramidSettings& settings = {});

}  // namespace wellspring::store
