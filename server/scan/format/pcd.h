// SPDX-License-Identifier: Apache-2.0
// Reads PCD files of the Point Cloud Library: text, binary, and compressed by LZF. Colours may be
// packed into the bits of one number (rgb, rgba).
#pragma once
#include <memory>
#include <string>
#include <string_view>

#include "scan/points.h"

namespace wellspring::scan {

// Throws LoadError.
std::unique_ptr<PointSource> open_pcd(const std::string& path);

// Says whether a file that begins so is one.
bool is_pcd(std::string_view head);

}  // namespace wellspring::scan
