// SPDX-License-Identifier: Apache-2.0
// What stands still of a picture at rest, as the light of lights that move needs it: found once
// while the view stays, so that of each picture only the light is new.
#pragma once
#include <cstdint>
#include <vector>

#include "light/dynamic/direct_light.h"
#include "light/visible/surface_buffer.h"

namespace wellspring::light {

struct BackdropSurfaces {
  View view;                         // of the picture
  SurfaceBuffer surfaces;            // in dynamic_light_view() of it, what moves left out
  std::vector<uint8_t> reflectance;  // of each pixel three: 255 times its root; 0 of what emits
  // Of each pixel the shares of 255 that the four pixels of light around it have, by
  // light_taps(), the first in the lowest byte. Empty: light has the picture's resolution.
  RawVector<uint32_t> shares;
};
size_t memory_bytes(const BackdropSurfaces& backdrop);

// Needs visibility.rasterises() of the view.
void find_backdrop_surfaces(const VisibilityPass& visibility, const View& view,
                            BackdropSurfaces& backdrop);

// Radiance that the pixels [x, x + count) of row y reflect of that light.
void reflect_light(const BackdropSurfaces& backdrop, const LightPlanes& light, int x, int y,
                   int count, RunKnown& to);

}  // namespace wellspring::light
