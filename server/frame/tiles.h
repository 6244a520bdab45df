// SPDX-License-Identifier: Apache-2.0
// A picture as tiles: which of them differ from those of another picture, and few rectangles that
// cover some of them.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "frame/frame.h"

namespace wellspring::frame {

struct ImagePart {
  int x = 0, y = 0, width = 0, height = 0;  // pixels from the upper left
  bool operator==(const ImagePart&) const = default;
};

inline constexpr int tile_side = 32;  // whole JPEG blocks, of subsampled pictures too

struct TileGrid {
  int width = 0, height = 0;  // of the picture, pixels
  int columns() const { return (width + tile_side - 1) / tile_side; }
  int rows() const { return (height + tile_side - 1) / tile_side; }
  size_t size() const { return size_t(columns()) * size_t(rows()); }
  ImagePart part(size_t tile) const;  // row by row; the last of a row or column may be smaller
};

// Whether any byte there differs by more than `tolerance`. Both pictures are of one size.
bool differs(const Image8& a, const Image8& b, const ImagePart& part, int tolerance);
// Rectangles of whole tiles, none over another, that cover all tiles of which `wanted` is not 0:
// exactly these, or at most `most` with some of the others, where that makes fewer and is cheap.
std::vector<ImagePart> cover(const TileGrid& grid, const std::vector<char>& wanted);
std::vector<ImagePart> cover(const TileGrid& grid, const std::vector<char>& wanted, size_t most);
// The tiles of such a rectangle.
std::vector<size_t> tiles_in(const TileGrid& grid, const ImagePart& part);
void copy_part(const Image8& from, const ImagePart& part, Image8& to);

}  // namespace wellspring::frame
