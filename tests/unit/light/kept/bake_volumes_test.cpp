// SPDX-License-Identifier: Apache-2.0
// Volumes shade the light that is kept.
#include <gtest/gtest.h>

#include <cmath>

#include "unit/light/kept/bake_cases.h"
#include "unit/light/volume_slab.h"

namespace wellspring::test {
namespace {

using namespace scenes;
using test::Baked;

// Mean light of all nodes of both fields, of a floor of 2 x 2 m.
double mean_light(const PlacedVolume* volume, Scene scene) {
  add_fan(scene, add_material(scene, diffuse(vec3(0.5f))), {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
  Baked baked(std::move(scene), {.gather_nodes = 64, .direct_nodes = 64});
  if (volume) baked.world.place_volumes({*volume});
  bake_passes(baked.lit, baked.bake, 64);
  double mean = 0;
  for (const BakeField* field : {&baked.bake.direct, &baked.bake.gather}) {
    double sum = 0, count = 0;
    for (size_t node = 0; node < field->nodes(); node++) {
      if (field->count[node] == 0) continue;
      count++;
      for (int layer = 0; layer < field->layers; layer++)
        sum += double(luminance(field->light_of(node)[layer] / float(field->count[node])));
    }
    mean += sum / std::max(count, 1.0);
  }
  return mean;
}

TEST(BakeVolumes, TheSunIsShadedByWhatComesThrough) {
  Scene scene = empty_scene();
  scene.lights.push_back({.type = PunctualType::directional, .direction = {0, -1, 0}});
  const PlacedVolume above = slab(0.8, {0, 2, 0}, 60);
  EXPECT_NEAR(mean_light(&above, scene) / mean_light(nullptr, scene), std::exp(-0.8), 0.02);
}

TEST(BakeVolumes, NoSkyComesThroughWhatIsOpaque) {
  Scene scene = empty_scene();
  scene.environment.radiance = vec3(1);
  EXPECT_NEAR(mean_light(nullptr, scene), 1, 0.02);
  const PlacedVolume around = slab(2000, {0, 0, 0}, 60);
  EXPECT_LT(mean_light(&around, scene), 1e-3);
}

TEST(BakeVolumes, AVolumesOwnLightIsKept) {
  const PlacedVolume bright = slab(2000, {0, 1, 0}, 60, 0.5f);
  const double light = mean_light(&bright, empty_scene());
  EXPECT_GT(light, 0.02);
  EXPECT_LT(light, 0.5);
}

}  // namespace
}  // namespace wellspring::test
