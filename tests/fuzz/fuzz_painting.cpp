// SPDX-License-Identifier: Apache-2.0
// Descriptions of paintings, and a tile of each level of those that are accepted.
#include "fuzz/fuzz.h"
#include "store/painting/painted_picture.h"

namespace wellspring::fuzz {

void fuzz_painting(Bytes bytes) {
  const std::string file = write_file("fuzz.painting.json", bytes);
  load([&] {
    const auto picture = store::open_painting(file, "", "de");
    for (int level = 0; level < int(picture->levels().size()); level++) {
      const auto tile = picture->fetch(store::PieceKey(1, level, 0, 0)).piece;
      require(tile && tile->bytes.size() == size_t(4 * tile->width * tile->height),
              "a tile has all of its texels");
    }
  });
}

}  // namespace wellspring::fuzz
