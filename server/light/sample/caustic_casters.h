// SPDX-License-Identifier: Apache-2.0
// What photons aim at: spheres around what scatters sharply, so that few miss it (Wald et al. 2002,
// section 4.1).
#pragma once
#include <span>
#include <vector>

#include "light/sample/light_tables.h"

namespace wellspring::light {

// Spheres around the instances whose material the plan calls sharp, large ones in parts. `moving`:
// those that move, else those that do not.
std::vector<CasterSphere> find_casters(const World& world, const TransportPlan& plan, bool moving);

// Density of directions towards the spheres as seen from a place, over solid angle; and one of
// them. Zero density: there is nothing to aim at.
float sample_caster_pdf(std::span<const CasterSphere> casters, vec3 from, vec3 direction);
vec3 sample_caster(std::span<const CasterSphere> casters, vec3 from, vec2 u);

}  // namespace wellspring::light
