// SPDX-License-Identifier: Apache-2.0
// What every pyramid of a large picture promises.
#pragma once
#include <algorithm>

#include "fuzz/fuzz.h"
#include "store/picture/pyramid.h"

namespace wellspring::fuzz {

// Checks the levels, and reads the first and the last tile of each.
inline void show_picture(const store::PicturePyramid& picture) {
  require(!picture.levels().empty() && picture.levels().size() <= 64, "levels have numbers");
  for (size_t i = 0; i < picture.levels().size(); i++) {
    const store::PyramidLevel& level = picture.levels()[i];
    require(level.width >= 1 && level.height >= 1 && level.width <= store::longest_picture &&
                level.height <= store::longest_picture,
            "a level has a size");
    require(level.columns() <= int(store::most_pieces_a_side) &&
                level.rows() <= int(store::most_pieces_a_side),
            "tiles have numbers");
    for (const bool is_last : {false, true})
      load([&] {
        const int column = is_last ? level.columns() - 1 : 0, row = is_last ? level.rows() - 1 : 0;
        const auto piece = picture.fetch({1, int(i), uint32_t(column), uint32_t(row)}).piece;
        if (!piece) return;
        require(piece->width == level.width_at(column) && piece->height == level.height_at(row),
                "a tile has the size that its level tells");
        require(piece->bytes.size() == size_t(piece->width) * size_t(piece->height) * 4,
                "a tile has all of its texels");
      });
  }
  const store::PyramidLevel& coarsest = picture.levels().back();
  require(std::max(coarsest.width, coarsest.height) <= store::coarsest_side,
          "the coarsest level is small");
}

}  // namespace wellspring::fuzz
