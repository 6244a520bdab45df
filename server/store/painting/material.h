// SPDX-License-Identifier: Apache-2.0
// Adds what age and ground do to painted surfaces, at the picture's true scale: cracks around
// islands of paint (the borders of cells of Worley 1996), the weave of the canvas, and grain. Each
// is a factor of the colour code; coarser levels have its mean.
#pragma once
#include <vector>

#include "store/painting/brush.h"
#include "store/painting/painting.h"

namespace wellspring::store {

// Multiplies `factors`, one a texel of `width` columns, by what the material does there.
void age_texels(std::vector<float>& factors, int width, const PaintMaterial& material,
                uint64_t seed, const StrokeWindow& window);

}  // namespace wellspring::store
