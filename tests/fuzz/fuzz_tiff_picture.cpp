// SPDX-License-Identifier: Apache-2.0
// Large pictures in TIFF files: pages, tiles, strips, colour profiles.
#include "fuzz/fuzz.h"
#include "fuzz/shown_picture.h"
#include "store/format/tiff_pyramid.h"

namespace wellspring::fuzz {

void fuzz_tiff_picture(Bytes bytes) {
  const std::string file = write_file("picture.tif", bytes);
  load([&] { show_picture(*store::load_tiff(file, 1 << 20)); });
}

}  // namespace wellspring::fuzz
