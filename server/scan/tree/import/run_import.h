// SPDX-License-Identifier: Apache-2.0
// All stages of an import, on a disk or in memory.
#pragma once
#include <vector>

#include "scan/tree/data_file.h"
#include "scan/tree/tree_settings.h"

namespace wellspring::scan {

// Makes the tree in a file of `place` named "tree", and gives that back whole. Throws LoadError.
DataFile import_points(const std::vector<TreeSource>& sources, const WorkPlace& place,
                       const TreeSettings& settings, const TreeProgress& progress,
                       TreeReport& report);

}  // namespace wellspring::scan
