// SPDX-License-Identifier: Apache-2.0
// Opens a file of scanned points, whatever its format.
#pragma once
#include <memory>
#include <string>

#include "scan/points.h"

namespace wellspring::scan {

// Tells formats apart by the file's first bytes, then by its name. Throws LoadError for what is no
// known format, and for Gaussian splats, which `splats` loads.
std::unique_ptr<PointSource> open_scan(const std::string& path);

}  // namespace wellspring::scan
