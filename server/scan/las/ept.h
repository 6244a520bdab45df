// SPDX-License-Identifier: Apache-2.0
// Opens a folder of EPT (Entwine Point Tile 1.0) as points.
#pragma once
#include <memory>
#include <string>

#include "scan/points.h"

namespace wellspring::scan {

// `path` names the folder or the ept.json in it. Nodes come once each, from the root on. Throws
// LoadError; a node that holds other points than the tree says is refused when its turn comes.
std::unique_ptr<PointSource> open_ept(const std::string& path);

}  // namespace wellspring::scan
