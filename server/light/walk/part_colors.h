// SPDX-License-Identifier: Apache-2.0
// Where walks meet what parts their colours (dispersion.h): a solid's own boundary, between the
// indices on both its sides. Walks of the eye and of light ask the same.
#pragma once
#include <optional>

#include "light/material/dispersion.h"
#include "light/sample/medium.h"
#include "light/sample/sample_light.h"

namespace wellspring::light {

// Never true where the plan has no dispersion.
bool parts_colors(const Transport& transport, const Media& media, const Surface& surface);

// Of a ray of that direction, where parts_colors(): spread_wavelengths with what lies on both
// sides.
void part_colors(const Transport& transport, const Media& media, vec3 direction,
                 const Surface& surface, const Wavelengths& carried, float u, Bsdf& bsdf,
                 std::optional<WavelengthSpread>& spread);

}  // namespace wellspring::light
