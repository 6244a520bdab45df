// SPDX-License-Identifier: Apache-2.0
#include "light/bake/coarse_light.h"

#include <algorithm>

#include "base/cancel.h"
#include "light/bake/bake.h"
#include "light/bake/finish_bake.h"

namespace wellspring::light {

static constexpr float least_bounce = 0.002f;  // of the mean light: a bounce that adds less ends it

BakeScene make_bake_scene(const World& world, std::span<const vec3> places,
                          const CoarseLightSettings& settings) {
  BakeScene scene = make_bake_scene_of_paths(world);
  BakeSettings coarse;
  coarse.gather_nodes = coarse.direct_nodes = settings.nodes;
  Bake bake = begin_bake(scene.world, places, coarse);
  if (bake.charts.tiles == 0) return scene;
  sample_fields(scene, bake, settings.direct_samples, 0);
  scene.known = finish_fields(bake, false);
  for (int bounce = 1; bounce < settings.most_bounces; bounce++) {
    check_cancelled();
    clear_samples(bake.gather);
    sample_fields(scene, bake, 0, 1);
    const float before = scene.known->mean;
    scene.known = finish_fields(bake, false);
    if (!(scene.known->mean - before > least_bounce * scene.known->mean)) break;
  }
  clear_samples(bake.gather);
  sample_fields(scene, bake, 0, settings.gather_samples);
  scene.known = finish_fields(bake, true);
  return scene;
}

}  // namespace wellspring::light
