// SPDX-License-Identifier: Apache-2.0
// Says how wind moves the grass in a picture, so that a display can go on with it.
#pragma once
#include <cstdint>
#include <vector>

#include "lawn/wind.h"

namespace wellspring::picture {

// Codes are means of blocks of pixels: as many units of pixels does a push of 1 (lawn/wind.h) move
// what they show.
struct SwayImage {
  static constexpr int block = 4;   // pixels a side
  static constexpr float unit = 1;  // pixels
  int columns = 0, rows = 0;        // blocks
  std::vector<uint8_t> code;        // row after row; empty: nothing sways
  Wind wind;                        // its strength is in the codes
  double time = 0;                  // the wind's clock, as the keyframe shows it
};

}  // namespace wellspring::picture
