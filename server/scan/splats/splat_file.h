// SPDX-License-Identifier: Apache-2.0
// Loads Gaussian splats from files of every format that is read.
#pragma once
#include <string>

#include "scan/splats/splat_set.h"

namespace wellspring::scan {

// Reads PLY (degree 0 to 3; also compressed by PlayCanvas), SPZ (versions 1 to 4), .splat, .ksplat,
// and glTF with KHR_gaussian_splatting. Splats with a value that is not finite are left out, a turn
// of length 0 is none; notices say so. Throws LoadError.
SplatSet load_splats(const std::string& path);

// Says whether a file holds splats, by its first bytes and, where a format has no mark, its name.
// Throws LoadError if it cannot be read, or begins as PLY and is none.
bool holds_splats(const std::string& path);

}  // namespace wellspring::scan
