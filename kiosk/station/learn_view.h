// SPDX-License-Identifier: Apache-2.0
// Makes views of photographs.
#pragma once
#include <string>
#include <vector>

#include "kiosk/tree/tree.h"

namespace wellspring::kiosk {

struct Photo {
  std::string file, side;
  int width = 0, height = 0;
  std::vector<uint8_t> bgr;  // the object alone
};

// Makes a view of a photograph, with the features that are found again under other views, light
// and noise.
View learn_view(const Photo& photo, vec2 size);
// Scales colour to the size of that view's picture.
std::vector<uint8_t> shrink_photo(const Photo& photo, int width, int height);

}  // namespace wellspring::kiosk
