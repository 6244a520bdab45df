// SPDX-License-Identifier: Apache-2.0
// Scans a scene as a terrestrial laser scanner does: from each station rays go to all sides but
// down to its tripod, evenly spaced on the sphere. Each first hit becomes a point with its colour
// and the intensity of the returning light; what no station sees is missing. Distances have noise,
// which grows at grazing angles (Soudarissanane et al. 2011, "Scanning geometry: Influencing factor
// on the quality of terrestrial laser scanning points", section 3); at edges the beam meets two
// surfaces, and some points hang in the air between them (mixed pixels).
#pragma once
#include <vector>

#include "scan/tree/coarse_cut.h"
#include "scan/tree/tree_settings.h"
#include "show/scanner/scanner_file.h"

namespace wellspring::show {

// Returns a source for each station, +Y up, which share the loaded scene. The step between rays is
// such that about min(most_points, scanner.points) come back. The same file gives the same points
// on any number of threads; reading takes all cores, and some megabytes a station. Throws
// LoadError.
std::vector<TreeSource> open_scanner(const ScannerFile& scanner, uint64_t most_points);

// Returns the bounds of the scanned scene, in its own coordinates. Throws LoadError.
PointBounds scanned_bounds(const ScannerFile& scanner);

}  // namespace wellspring::show
