// SPDX-License-Identifier: Apache-2.0
// Linear radiance to 8-bit sRGB for the eye. Called once a frame per visitor; never blocks, never
// fails: NaN and negative values become black, infinity white.
#pragma once
#include "frame/frame.h"

namespace wellspring::frame {

struct Tonemap {
  float exposure = 1;  // multiplies radiance before the curve
};

// Overwrites `out` (resized to the frame). Deterministic; dithering is not applied.
void tonemap(const Frame& frame, const Tonemap& settings, Image8& out);

}  // namespace wellspring::frame
