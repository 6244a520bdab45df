// SPDX-License-Identifier: Apache-2.0
// Reads the vertices of PLY files as points: text, and binary of both byte orders. Lists and other
// elements, such as faces, are passed over.
#pragma once
#include <memory>
#include <string>

#include "scan/points.h"

namespace wellspring::scan {

// Throws LoadError, also for files of Gaussian splats.
std::unique_ptr<PointSource> open_ply(const std::string& path);

}  // namespace wellspring::scan
