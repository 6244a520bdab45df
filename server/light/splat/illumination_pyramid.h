// SPDX-License-Identifier: Apache-2.0
// The paper's illumination buffer: irradiance of each subsplat at its own resolution.
#pragma once
#include <vector>

#include "base/raw_vector.h"
#include "base/vec.h"

namespace wellspring::light {

// Irradiance, W/m^2; `held` is 1, and 0 of a texel without any.
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

}  // namespace wellspring::light
