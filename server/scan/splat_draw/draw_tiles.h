// SPDX-License-Identifier: Apache-2.0
// Sorts splats from the front to the back, lists those that touch each tile of a picture, and keeps
// what has been drawn of a tile.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "scan/splat_draw/draw_project.h"

namespace wellspring::scan {

inline constexpr int tile_width = 32, tile_height = 16;
// Rows in memory are longer than in the picture: eight pixels may begin at any of them.
inline constexpr int tile_stride = tile_width + lane_count;

struct SplatGrid {
  int across = 0, down = 0;
  SplatGrid(int width, int height)
      : across((width + tile_width - 1) / tile_width),
        down((height + tile_height - 1) / tile_height) {}
  int count() const { return across * down; }
};

// Holds the pixels of a tile. Those outside of the picture are opaque already.
struct alignas(64) SplatTile {
  float clear[tile_height * tile_stride];     // share of the light behind that comes through
  float color[3][tile_height * tile_stride];  // display codes, times what is not clear
  float nearness[tile_height * tile_stride];  // one over the median depth, 0: none
};

struct SplatLists {
  std::vector<uint32_t> first;   // for each tile its place in `splats`, and where the last one ends
  std::vector<uint32_t> splats;  // indices in DrawnSplats::splats
  std::span<const uint32_t> of(int tile) const {
    return std::span(splats).subspan(first[size_t(tile)],
                                     first[size_t(tile) + 1] - first[size_t(tile)]);
  }
};

// Sorts keys by depth, to about two millionths of it; equal ones stay as they were. `spare` is
// room to work in.
void sort_by_depth(std::vector<DrawnKey>& keys, std::vector<DrawnKey>& spare);

// Lists splats in the order of `keys`, of which `boxes` are the places in the picture, for tiles in
// rows from `first_row` to before `last_row`.
// Tiles leave out splats that are all farther than 1 / `limits`: 0 leaves out none, infinity all.
void list_splats(SplatLists& lists, const DrawnSplats& drawn, std::span<const DrawnKey> keys,
                 std::span<const PixelBox> boxes, const SplatGrid& grid,
                 std::span<const float> limits, int first_row, int last_row);

}  // namespace wellspring::scan
