// SPDX-License-Identifier: Apache-2.0
// Colours as version 0 of VRM keeps them: as Unity's materials do.
#pragma once
#include <algorithm>
#include <cmath>

#include "base/vec.h"

namespace wellspring::avatar {

// IEC 61966-2-1 up to 1, beyond it, where colours glow, a power of 2.2. Below 0: 0.
inline vec3 linear_of_unity(vec3 color) {
  vec3 linear(0);
  for (int c = 0; c < 3; c++) {
    float v = std::min(color[c], 1e4f);
    if (!(v > 0)) continue;
    linear[c] = v <= 0.04045f ? v / 12.92f
                : v < 1       ? std::pow((v + 0.055f) / 1.055f, 2.4f)
                              : std::pow(v, 2.2f);
  }
  return linear;
}

}  // namespace wellspring::avatar
