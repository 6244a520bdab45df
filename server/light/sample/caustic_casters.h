// SPDX-License-Identifier: Apache-2.0
// Finds what photons aim at: spheres around surfaces that scatter sharply, so that few photons miss
// (Wald et al. 2002, section 4.1).
#pragma once
#include <span>
#include <vector>

#include "light/sample/light_tables.h"

namespace wellspring::light {

// Returns spheres around the instances whose material the plan calls sharp; large instances are cut
// into parts. `moving`: takes those that move, else those that stand still.
std::vector<CasterSphere> find_casters(const World& world, const TransportPlan& plan, bool moving);

// Returns the density of directions towards the spheres as seen from a place, over solid angle (0:
// there is nothing to aim at); draws one of these directions.
float sample_caster_pdf(std::span<const CasterSphere> casters, vec3 from, vec3 direction);
vec3 sample_caster(std::span<const CasterSphere> casters, vec3 from, vec2 u);

}  // namespace wellspring::light
