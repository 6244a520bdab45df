// SPDX-License-Identifier: Apache-2.0
// What a choice among lights needs to know of emitting triangles and punctual lights.
#pragma once
#include "light/sample/light_tables.h"

namespace wellspring::light {

// `power[i]` of emitters[i], both sides counted; those without are never picked.
LightTree make_emitter_tree(std::span<const EmitterTriangle> emitters, std::span<const float> power,
                            LightChoice choice);

// Few punctual lights are asked one by one for what they send to a place, which knows each better
// than a tree does; more are chosen from near_choice and distant_choice.
void add_punctual_choice(LightTables& tables);

// Makes `emitter.picture` where its emission varies much; `texels`: of the picture on the triangle.
void add_emission_picture(const World& world, float texels, EmitterTriangle& emitter,
                          LightTables& tables);

}  // namespace wellspring::light
