// SPDX-License-Identifier: Apache-2.0
// Light of few nodes, found in a second or two: on it gathering walks of a bake end, and it is what
// an exhibit shows that has nothing better yet.
#pragma once
#include <span>

#include "light/bake/bake_scene.h"

namespace wellspring::light {

struct CoarseLightSettings {
  size_t nodes = 40000;                        // at most, about
  int direct_samples = 6, gather_samples = 6;  // of each node; those of the last bounce
  int most_bounces = 40;
};

// A scene of which coarse light is known, null where nothing is diffuse: light straight from its
// sources, then bounce by bounce what surfaces send each other of what is known so far (as
// progressive radiosity: Cohen et al. 1988). Eyes are near `places` (scene coordinates). `world` as
// for make_bake_scene_of_paths(). All cores; the same bits whatever the number of threads. May be
// cancelled.
BakeScene make_bake_scene(const World& world, std::span<const vec3> places,
                          const CoarseLightSettings& settings = {});

}  // namespace wellspring::light
