// SPDX-License-Identifier: Apache-2.0
// Opens files of the LAS family as points.
#pragma once
#include <memory>
#include <string>

#include "scan/points.h"

namespace wellspring::scan {

// Opens a LAS, LAZ or COPC file, which its content tells, not its name. Points of a COPC file come
// in the order of its chunks. Times that are no numbers become 0, with a notice. Throws LoadError.
std::unique_ptr<PointSource> open_las(const std::string& path);

}  // namespace wellspring::scan
