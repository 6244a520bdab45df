// SPDX-License-Identifier: Apache-2.0
// Makes a piece of an exhibit of a picture of many bands.
#pragma once
#include <string>
#include <vector>

#include "base/layers.h"

namespace wellspring::program {

struct BandImport {
  std::string path;       // as store/band_files/band_source.h reads it
  std::string out = ".";  // folder for the picture
  std::string name;       // the picture's; empty: as the path's
  double width = 0;       // metres; 0: unknown
  int bits = 8;           // 8 or 16
  int quality = 0;        // JPEG tiles' quality; 0: no losses but those of 8 bits
  // Layers of these are proposed.
  std::vector<std::string> lamps{"candle", "A"};
  bool overwrite = false;  // replaces a picture that is there
};

// Writes NAME.tif, tells on stderr what it is, and prints a piece for exhibit.json with layers of
// lamps and, where bands reach beyond what is seen, false colours; or a layer alone, of bands that
// tell no colours. Throws LoadError.
void import_bands(const BandImport& import);

}  // namespace wellspring::program
