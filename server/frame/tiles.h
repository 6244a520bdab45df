// SPDX-License-Identifier: Apache-2.0
// Cuts a picture into tiles: finds which of them differ from those of another picture, and few
// rectangles that cover some of them.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "image/image.h"

namespace wellspring::frame {

inline constexpr int tile_side = 32;  // pixels; whole JPEG blocks, of subsampled pictures, too

struct TileGrid {
  int width = 0, height = 0;  // size of the picture, pixels
  int columns() const { return (width + tile_side - 1) / tile_side; }
  int rows() const { return (height + tile_side - 1) / tile_side; }
  size_t size() const { return size_t(columns()) * size_t(rows()); }
  ImagePart part(size_t tile) const;  // row by row; the last of a row or column may be smaller
};

// Returns whether any byte there differs by more than `tolerance`. Both pictures are of one size.
bool differs(const Image8& a, const Image8& b, const ImagePart& part, int tolerance);
// Returns rectangles of whole tiles, none over another, that cover all tiles whose `wanted` is not
// 0: exactly these, or at most `most` rectangles with some of the other tiles, if that makes fewer
// and is cheap.
std::vector<ImagePart> cover(const TileGrid& grid, const std::vector<char>& wanted);
std::vector<ImagePart> cover(const TileGrid& grid, const std::vector<char>& wanted, size_t most);
// Returns the tiles of such a rectangle.
std::vector<size_t> tiles_in(const TileGrid& grid, const ImagePart& part);
void copy_part(const Image8& from, const ImagePart& part, Image8& to);

// Shrinks a picture: each new pixel is the mean of the area that it covers.
// width and height: at least 1, at most the picture's. Bytes are averaged as they are, in sRGB: a
// picture that is shown small for a moment need not be exact.
Image8 shrink(const Image8& image, int width, int height);

}  // namespace wellspring::frame
