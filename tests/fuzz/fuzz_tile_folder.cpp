// SPDX-License-Identifier: Apache-2.0
// Descriptions of pictures whose tiles are files: Deep Zoom, Zoomify, IIIF.
#include "fuzz/fuzz.h"
#include "fuzz/shown_picture.h"
#include "store/format/iiif_folder.h"
#include "store/format/tile_folder.h"

namespace wellspring::fuzz {

void fuzz_tile_folder(Bytes bytes) {
  const std::string file = write_file("tiles.xml", bytes);
  load([&] {
    show_picture(*(text_of(bytes).starts_with("{") ? store::load_iiif_folder(file)
                                                   : store::load_tile_folder(file)));
  });
}

}  // namespace wellspring::fuzz
