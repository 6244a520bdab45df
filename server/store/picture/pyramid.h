// SPDX-License-Identifier: Apache-2.0
// Describes a very large picture as a pyramid of levels, each cut into tiles, whatever the format.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "store/piece.h"

namespace wellspring::store {

// Holds a level of a picture. Tiles at the right and lower edge are smaller.
struct PyramidLevel {
  int64_t width = 1, height = 1;            // texels
  int tile_width = 256, tile_height = 256;  // texels
  int columns() const { return int((width + tile_width - 1) / tile_width); }
  int rows() const { return int((height + tile_height - 1) / tile_height); }
  // Size of a tile in texels.
  int width_at(int column) const {
    const int64_t left = width - int64_t(column) * tile_width;
    return int(left < tile_width ? left : tile_width);
  }
  int height_at(int row) const {
    const int64_t left = height - int64_t(row) * tile_height;
    return int(left < tile_height ? left : tile_height);
  }
};

inline constexpr int64_t longest_picture = int64_t(1) << 30;  // texels a side
inline constexpr int largest_tile = 4096;                     // texels a side
inline constexpr int most_levels = 40;
// The coarsest level of a pyramid has at most so many texels a side: it is read at once, and kept,
// of each of the hundreds of pictures that a hall may have.
inline constexpr int64_t coarsest_side = 256;

class PicturePyramid : public PieceSource {
 public:
  // Levels from the finest, 0, to the coarsest; never empty.
  const std::vector<PyramidLevel>& levels() const { return levels_; }
  // Returns the tile of exactly the size that its level tells, RGBA; alpha is 255 where the picture
  // has none. A tile whose file is not there is absent. Throws LoadError for one that is damaged or
  // of another size.
  Fetched fetch(PieceKey key) const override = 0;
  // Returns the tile as a JPEG file that shows the same texels, if it is stored as one and nothing
  // has to be decoded for that; else nothing. Throws LoadError for a file that cannot be read.
  virtual std::vector<uint8_t> stored_jpeg(PieceKey) const { return {}; }
  // Returns the languages that it has words in; empty: it is the same in all.
  const std::vector<std::string>& languages() const { return languages_; }

 protected:
  std::vector<PyramidLevel> levels_;
  std::vector<std::string> languages_;
};

// Reads a whole level into one piece; only for levels of at most `coarsest_side` texels a side.
// Tiles that are absent are transparent black.
Piece read_level(const PicturePyramid& pyramid, int level);

}  // namespace wellspring::store
