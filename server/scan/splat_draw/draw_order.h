// SPDX-License-Identifier: Apache-2.0
// Puts splats in order from the front: a radix sort of keys, by all cores.
#pragma once
#include <vector>

#include "scan/splat_draw/draw_project.h"

namespace wellspring::scan {

// Sorts keys by depth, to about two millionths of it; equal ones stay as they were. `spare` is
// room to work in.
void sort_by_depth(std::vector<DrawnKey>& keys, std::vector<DrawnKey>& spare);

}  // namespace wellspring::scan
