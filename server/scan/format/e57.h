// SPDX-License-Identifier: Apache-2.0
// Reads the points of E57 files (ASTM E2807-11): several scans, each in its scanner's frame with a
// pose, in Cartesian or spherical coordinates. Points are given in the file's frame, in metres; a
// scan is a station. Pictures are not read.
#pragma once
#include <memory>
#include <string>

#include "scan/points.h"

namespace wellspring::scan {

// Throws LoadError.
std::unique_ptr<PointSource> open_e57(const std::string& path);

}  // namespace wellspring::scan
