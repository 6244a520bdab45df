// SPDX-License-Identifier: Apache-2.0
// Reads the points of glTF 2.0 files: primitives of mode 0 (section 3.7.2.1) of the nodes that the
// scene shows, where these place them.
#pragma once
#include <memory>
#include <string>

#include "scan/points.h"

namespace wellspring::scan {

// The whole file is in memory, as are its points (gltf/file.h bounds both). Throws LoadError, also
// if all points are Gaussian splats.
std::unique_ptr<PointSource> open_gltf_points(const std::string& path);

}  // namespace wellspring::scan
