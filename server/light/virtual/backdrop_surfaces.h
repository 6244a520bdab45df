// SPDX-License-Identifier: Apache-2.0
// Keeps the still surfaces of a picture at rest, as the light of lights that move needs them: found
// once while the view stays, so that only the light is new in each picture.
#pragma once
#include <cstdint>
#include <vector>

#include "light/virtual/direct_light.h"
#include "light/visible/surface_buffer.h"

namespace wellspring::light {

struct BackdropSurfaces {
  View view;               // view of the picture
  SurfaceBuffer surfaces;  // in its dynamic_light_view(), without what moves
  // Three for each pixel: 255 times its root; 0 if the pixel only emits
  std::vector<uint8_t> reflectance;
  // For each pixel the weights, in 255ths, of the four pixels of light around it, by light_taps(),
  // the first in the lowest byte. Empty: light has the picture's resolution.
  RawVector<uint32_t> shares;
};
size_t memory_bytes(const BackdropSurfaces& backdrop);

// Fills `backdrop`. The view must be one that visibility.rasterises().
void find_backdrop_surfaces(const VisibilityPass& visibility, const View& view,
                            BackdropSurfaces& backdrop);

// Computes the radiance that the pixels [x, x + count) of row y reflect of that light.
void reflect_light(const BackdropSurfaces& backdrop, const LightPlanes& light, int x, int y,
                   int count, RunKnown& to);

}  // namespace wellspring::light
