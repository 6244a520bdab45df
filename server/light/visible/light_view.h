// SPDX-License-Identifier: Apache-2.0
// The light of a drawn picture may be coarser than the picture: half of its resolution, where
// samples are few (picture/compose_drawn.h).
#pragma once
#include "world/view.h"

namespace wellspring {

inline constexpr int light_scale = 2;  // pixels of the picture a side of one pixel of its light

// The view of such coarser light: its pixels are light_scale pixels of the picture wide.
inline View light_view(const View& view) {
  View light = view;
  light.width = (view.width + light_scale - 1) / light_scale;
  light.height = (view.height + light_scale - 1) / light_scale;
  light.tan_half_fov = view.tan_half_fov * float(light.height * light_scale) / float(view.height);
  return light;
}

}  // namespace wellspring
