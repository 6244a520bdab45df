// SPDX-License-Identifier: Apache-2.0
// Pictures of reflectances in a light from one direction, without noise: what differs between two
// of them is not the light's.
#pragma once
#include <vector>

#include "frame/frame.h"
#include "light/visible/visibility.h"

namespace wellspring::test {

struct DrawnPicture {
  Image8 image;
  std::vector<float> depth;
};

void draw_picture(const VisibilityPass& visibility, const View& view, DrawnPicture& drawn);

}  // namespace wellspring::test
