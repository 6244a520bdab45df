// SPDX-License-Identifier: Apache-2.0
// Carries light from subsplats back to pixels, coarse to fine (Nichols and Wyman 2009, section
// 3.5): a texel without light of its own takes the bilinear mean of the level above, of those
// texels only that hold some and that no discontinuity parts from the one it lies in. So light is
// neither pulled from empty texels nor spread across an edge, even along the border of two coarse
// texels.
#pragma once
#include <span>
#include <vector>

#include "base/memory.h"
#include "base/vec.h"
#include "light/virtual/min_max_pyramid.h"

namespace wellspring::light {

// Holds the paper's illumination buffer: irradiance of each subsplat at its own resolution.

// Holds irradiance, W/m^2; `held` is 1, or 0 if the texel has none.
struct IlluminationTexel {
  float red = 0, green = 0, blue = 0, held = 0;
};

struct IlluminationLevel {
  int columns = 0, rows = 0;
  RawVector<IlluminationTexel> texels;  // at least columns * rows
  IlluminationTexel& at(int x, int y) { return texels[size_t(y) * size_t(columns) + size_t(x)]; }
  const IlluminationTexel& at(int x, int y) const {
    return texels[size_t(y) * size_t(columns) + size_t(x)];
  }
};

// Level k has squares of 2^k pixels.
struct IlluminationPyramid {
  std::vector<IlluminationLevel> levels;
};

// Holds for each texel the neighbours that it may be mixed with: workspace.
struct UpsampleRoom {
  RawVector<uint8_t> joined;
};

// Fills every texel below those that hold light, and writes level 0 to `irradiance`, 0 where
// nothing is lit. settings.detail: the surface detail term of section 4.2, by the cosine between
// normal and eye, where no subsplat was a pixel. Runs on all cores.
void upsample(const SplatPixels& pixels, const MinMaxPyramid& pyramid,
              const SplatSettings& settings, IlluminationPyramid& illumination, UpsampleRoom& room,
              std::span<vec3> irradiance);

}  // namespace wellspring::light
