// SPDX-License-Identifier: Apache-2.0
// How a picture's edges cut its pixels: what Raster finds and whoever softens edges uses.
#pragma once
#include <cstdint>
#include <functional>

#include "base/simd.h"

namespace wellspring::world {

// Of `pixel` (row after row from the picture's top left), the share that is covered by what
// `other`, a neighbour or a pixel near, shows: above 0, at most a half. Exact where one straight
// edge cuts it.
struct EdgeShare {
  uint32_t pixel = 0, other = 0;
  float share = 0;
};

// By how many codes of 255 `count` pixels side by side (at most eight; other lanes: anything)
// differ from those `step` further on. Edges that change less than a code or two are left out; if
// it is empty, none is.
using PixelsDiffer = std::function<Lanes(uint32_t pixel, uint32_t step, int count)>;

}  // namespace wellspring::world
