// SPDX-License-Identifier: Apache-2.0
// Plain pictures that are shown as large ones, with their orientation and colour profile.
#include "fuzz/fuzz.h"
#include "fuzz/shown_picture.h"
#include "store/format/plain_picture.h"

namespace wellspring::fuzz {

void fuzz_plain_picture(Bytes bytes) {
  const std::string file = write_file("picture.any", bytes);
  load([&] { show_picture(*store::load_plain_picture(file, 1 << 20)); });
}

}  // namespace wellspring::fuzz
