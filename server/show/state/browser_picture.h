// SPDX-License-Identifier: Apache-2.0
// What a browser that takes parts has on its screen, while its visitor stands
// (show/draw/parts.h).
#pragma once
#include <cstdint>
#include <vector>

#include "frame/tiles.h"

namespace wellspring::show {

struct BrowserPicture {
  Image8 image;                    // before it was encoded; empty: the next one is complete
  std::vector<uint8_t> quality;    // JPEG's, of each tile; 0: it is not there in full size
  std::vector<double> changed_at;  // seconds, of each tile: when its content last did
  size_t next = 0, next_fine = 0;  // tiles at which the next parts begin
  bool pending = false;  // some tiles could be finer, or are not quite what was drawn last
};

}  // namespace wellspring::show
