// SPDX-License-Identifier: Apache-2.0
// A borrowed picture of grey levels, and squares cut out of it for a network.
#pragma once
#include <cstdint>

#include "base/vec.h"
#include "kiosk/network/network.h"

namespace wellspring::kiosk {

struct GrayView {
  const uint8_t* pixels = nullptr;  // row by row, top row first
  int width = 0, height = 0;
};

// A rectangle of the picture, turned about its middle: a positive angle (radians) turns its upper
// side towards image left, as a head with that roll.
struct Cut {
  vec2 middle{0};  // pixels of the picture
  float width = 0, height = 0, angle = 0;
};

// The cut at `columns` by `rows` pixels, alike in all three colours; smoothed before it gets
// smaller. Beyond the picture its rim goes on.
NetworkInput cut_out(const GrayView& picture, const Cut& cut, int columns, int rows);

// Where a point of the cut (shares 0..1 from its upper left) is in the picture, pixels.
vec2 cut_to_picture(const Cut& cut, vec2 share);

}  // namespace wellspring::kiosk
