// SPDX-License-Identifier: Apache-2.0
// Reads pyramids of which every tile is a file of its own: Deep Zoom, Zoomify. Names of files are
// made of numbers and known words, so that nothing outside of the picture's folder is read.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "image/image.h"
#include "store/picture/kept_levels.h"

namespace wellspring::store {

class TileFolder : public KeptLevels {
 protected:
  struct TileFile {
    std::vector<std::string> paths;  // files that may hold the tile, the likeliest first
    int width = 0, height = 0;       // texels of the file's picture
    image::ImagePart part;           // the part of it that is the tile
  };
  virtual TileFile file_of(PieceKey key) const = 0;
  Fetched fetch_stored(PieceKey key) const override;
  std::vector<uint8_t> take_stored_jpeg(PieceKey key) const override;
};

// Returns the picture of the first file that is there; null: none is.
std::shared_ptr<Piece> read_tile_file(const std::vector<std::string>& paths);

// Says whether a level has tiles of 16 to `largest_tile` texels a side, and not too many.
bool can_be_cut(const PyramidLevel& level);

// Opens the pyramid that an XML file describes: a Deep Zoom .dzi, or Zoomify's ImageProperties.xml
// (Zoomify's levels are rounded down, or up where its coarsest tile is).
std::shared_ptr<const PicturePyramid> load_tile_folder(const std::string& file);

}  // namespace wellspring::store
