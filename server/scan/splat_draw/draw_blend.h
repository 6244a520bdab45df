// SPDX-License-Identifier: Apache-2.0
// Blends the splats of a tile from the front to the back, eight pixels at a time, in display codes,
// as splats are trained.
#pragma once
#include <span>

#include "scan/splat_draw/draw_tiles.h"

namespace wellspring::scan {

// A tile in the picture: its first pixel, and one over the depth of the surface at each of its
// pixels, tile_stride a row, 0 where there is none. Null: no surface is nearer than any splat.
struct SplatTilePlace {
  int x = 0, y = 0;
  const float* surface = nullptr;
};

// Blends in the order of the list. Stops where less than 1/255 of the light comes through all
// pixels, and returns whether it did.
bool blend_in_order(SplatTile& pixels, const DrawnSplats& drawn, std::span<const uint32_t> list,
                    const SplatTilePlace& place);

// Blends at each pixel in the order of depths there, so nothing pops when the eye turns (Radl et
// al. 2024, "StopThePop", section 4). The list must be in the order of nearest depths. A pixel
// holds back 512 splats at most to sort them; of more that overlap in depth the nearest is blended
// early.
void blend_by_pixel(SplatTile& pixels, const DrawnSplats& drawn, std::span<const uint32_t> list,
                    const SplatTilePlace& place);

}  // namespace wellspring::scan
