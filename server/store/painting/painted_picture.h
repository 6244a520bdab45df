// SPDX-License-Identifier: Apache-2.0
// Opens paintings: pictures without end that are painted on demand, tile by tile, from a small
// description (painting_file.h). Everything is a function of the description and the place, so any
// window of a level has the same texels.
#pragma once
#include <memory>
#include <string>

#include "store/painting/painting.h"
#include "store/picture/pyramid.h"

namespace wellspring::store {

class PaintedPicture : public PicturePyramid {
 public:
  PaintedPicture(std::string file, Painting painting, size_t layer);
  // Paints a tile. Throws a LoadError if more is drawn there than can be painted at once. Tiles
  // outside are absent.
  Fetched fetch(PieceKey key) const override;
  // Paints any window of a level, from 1 to `largest_tile` texels a side, which must lie within it.
  Piece paint(int level, int64_t left, int64_t top, int width, int height) const;

 private:
  const std::string file_;
  const Painting painting_;
  const size_t layer_;
};

// Opens a painting (".painting.json"). `layer`: the name of one of its layers; empty: the first.
// `language`: labels are in it, else in English. Throws LoadError, which names the file and the
// place in it, also if it has no such layer.
std::shared_ptr<const PaintedPicture> open_painting(const std::string& path,
                                                    const std::string& layer = "",
                                                    const std::string& language = "en");

// Opens outlines (".geojson", RFC 7946) as a map on white paper: its bbox, or the bounds of what it
// has with a border around. It counts as a metre wide. Features may say how they are drawn by
// GitHub's properties ("stroke", "fill", ...). Throws LoadError as above.
std::shared_ptr<const PaintedPicture> open_geojson(const std::string& path,
                                                   const std::string& language = "en");

}  // namespace wellspring::store
