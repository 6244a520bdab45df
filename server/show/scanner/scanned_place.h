// SPDX-License-Identifier: Apache-2.0
// Gives the tree of points of a .scanner.json: the whole one that somebody has imported beside it,
// else one of fewer points, which is made at first and kept.
#pragma once
#include <string>

#include "scan/tree/coarse_cut.h"
#include "scan/tree/point_tree.h"
#include "show/scanner/scanner_file.h"

namespace wellspring::show {

struct ScannedPlace {
  PointTree points;
  PointBounds box;  // the scene's, relative to the tree's origin: the same for any number of points
};

// `cache`: folder where a tree of some millions of points is kept until the scan's files change;
// empty, or one that cannot be written to: a coarse one is made in memory, within a second or two.
// Progress goes to the log. Throws LoadError if the scene cannot be read.
ScannedPlace open_scanned_place(const ScannerFile& scanner, const std::string& cache);

}  // namespace wellspring::show
