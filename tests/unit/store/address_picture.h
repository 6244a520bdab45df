// SPDX-License-Identifier: Apache-2.0
// A picture of any size whose texels tell where they are from: for tests of what is shown.
#pragma once
#include <cmath>
#include <functional>

#include "store/picture/pyramid.h"

namespace wellspring::test {

// Level in red, column of the tile in green, its row in blue, each modulo 256.
class AddressPicture : public PicturePyramid {
 public:
  AddressPicture(int64_t width, int64_t height, int tile = 256) {
    for (;;) {
      levels_.push_back({width, height, tile, tile});
      if (width <= tile && height <= tile) break;
      width = std::max<int64_t>((width + 1) / 2, 1),
      height = std::max<int64_t>((height + 1) / 2, 1);
    }
  }
  // Lifetimes of what is fetched.
  double soft = std::numeric_limits<double>::infinity();
  double hard = std::numeric_limits<double>::infinity();

  Fetched fetch(PieceKey key) const override {
    fetches++;
    if (before) before(key);
    const PyramidLevel& level = levels_[size_t(key.level())];
    auto piece = std::make_shared<store::Piece>();
    piece->width = level.width_at(int(key.column()));
    piece->height = level.height_at(int(key.row()));
    for (int i = 0; i < piece->width * piece->height; i++)
      for (uint32_t byte : {uint32_t(key.level()), key.column(), key.row(), 255u})
        piece->bytes.push_back(uint8_t(byte));
    return {piece, soft, hard};
  }
  std::function<void(PieceKey)> before;  // called first
  mutable std::atomic<int> fetches{0};
};

}  // namespace wellspring::test
