// SPDX-License-Identifier: Apache-2.0
// Files of outlines, and a tile of each level of those that are accepted.
#include "fuzz/fuzz.h"
#include "store/painting/painted_picture.h"

namespace wellspring::fuzz {

void fuzz_geojson(Bytes bytes) {
  const std::string file = write_file("fuzz.geojson", bytes);
  load([&] {
    const auto picture = store::open_geojson(file, "de");
    for (int level = 0; level < int(picture->levels().size()); level++) {
      const auto& size = picture->levels()[size_t(level)];
      const store::PieceKey key(1, level, uint32_t(size.columns() / 2), uint32_t(size.rows() / 2));
      const auto tile = picture->fetch(key).piece;
      require(tile && tile->bytes.size() == size_t(4 * tile->width * tile->height),
              "a tile has all of its texels");
    }
  });
}

}  // namespace wellspring::fuzz
