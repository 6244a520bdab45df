// SPDX-License-Identifier: Apache-2.0
// How a picture's edges cut its pixels: what Raster finds and whoever softens edges uses.
#pragma once
#include <cstdint>

namespace wellspring {

// Of `pixel` (row after row from the picture's top left), the share that is covered by what
// `other`, a neighbour or a pixel near, shows: above 0, at most a half. Exact where one straight
// edge cuts it.
struct EdgeShare {
  uint32_t pixel = 0, other = 0;
  float share = 0;
};

}  // namespace wellspring
