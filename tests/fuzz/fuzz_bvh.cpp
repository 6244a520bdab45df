// SPDX-License-Identifier: Apache-2.0
// Recorded motions.
#include "avatar/load/bvh_load.h"
#include "fuzz/shown_figure.h"

namespace wellspring::fuzz {

void fuzz_bvh(Bytes bytes) {
  load([&] { show_figure(character_from_bvh("fuzz.bvh", text_of(bytes))); });
}

}  // namespace wellspring::fuzz
