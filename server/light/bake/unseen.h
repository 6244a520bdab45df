// SPDX-License-Identifier: Apache-2.0
// Parts of surfaces that no eye can see, because they lie beyond another surface that passes
// through theirs: a rib goes on above the vault, a floor below the wall. Light there is another,
// and must not leak into what is seen beside it.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "light/bake/bake_field.h"

namespace wellspring::light {

// What is known of each node; 0: nobody asked yet.
enum NodeSight : uint8_t { sight_unknown, sight_seen, sight_unseen };

// Of each node whether its light is to be taken from its neighbours: no eye sees it while one sees
// a neighbour whose light is very different, or it stands for parts of both. `eyes`: scene
// coordinates; without any all is seen. `sight`: kept from call to call, of the same field.
std::vector<uint8_t> find_leaks(const World& world, const BakeCharts& charts,
                                std::span<const TilePlace> places, std::span<const vec3> eyes,
                                const BakeField& field, std::vector<uint8_t>& sight);

}  // namespace wellspring::light
