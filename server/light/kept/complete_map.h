// SPDX-License-Identifier: Apache-2.0
// Adds to a map the light of things that were not there when it was baked, so that a new show-case
// takes minutes, not an hour.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "light/kept/bake.h"
#include "light/kept/map_file.h"

namespace wellspring::light {

// Metres around new things in which the light of others is found anew: their shadow and what they
// reflect.
inline constexpr float reach_of_new = 1.5f, reach_of_neighbours = 2.2f;

// Returns for each of the bake's tiles whether the map has no light for it, or it lies within
// `reach` metres of such a thing or of a lamp without light. `known`: load_map() of another scene,
// whose tiles have the size of the bake's (BakeSettings::tile).
std::vector<char> find_new_tiles(const World& world, const Bake& bake, const LoadedMap& known,
                                 float reach = reach_of_new);

// Returns a map that has `fresh` light, finish_map() of the bake, in the tiles that are new, and
// known light in all others. Its error is that of the known light. The bake has sampled these and
// their neighbours at least, since borders are made to agree.
std::shared_ptr<const IlluminationMap> complete_map(const World& world, const Bake& bake,
                                                    const IlluminationMap& known,
                                                    const IlluminationMap& fresh,
                                                    const std::vector<char>& is_new);

}  // namespace wellspring::light
