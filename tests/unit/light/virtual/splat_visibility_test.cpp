// SPDX-License-Identifier: Apache-2.0
// Shadows of virtual lights: few rays, right in the mean.
#include "light/virtual/splat_visibility.h"
#include "unit/light/virtual/splat_stage.h"
#include "unit/light/statistics.h"

using namespace wellspring;

using namespace wellspring::test;
using namespace wellspring::scenes;
using namespace wellspring::test;

namespace {

SplatStage make_box(int side, bool blocks = true) {
  Scene scene = make_cornell_box();
  for (Material& m : scene.materials) m.emission = vec3(0);
  if (!blocks) scene.instances.resize(6);
  PunctualLight light;
  light.position = {0.1f, 0.4f, -0.2f};
  light.intensity = {2, 3, 4};
  scene.lights.push_back(light);
  View view = cornell_view(scene, side, side);
  return {std::move(scene), view};
}

// The light of all virtual lights that a place sees.
dvec3 seen_light(const SplatStage& stage, vec3 place, vec3 normal, float depth) {
  const VirtualLights& lights = stage.drawn.lights;
  dvec3 sum(0);
  vec3 from = shadow_origin(place, normal, depth);
  for (size_t i = 0; i < size_t(lights.count); i++) {
    Ray ray;
    ray.origin = from;
    ray.direction = lights.target[i] - from;
    ray.t_max = 1;
    if (!stage.world.occluded(ray)) sum += dvec3(eval_virtual_light(lights, i, place, normal));
  }
  return sum;
}

}  // namespace

TEST(SplatVisibility, ShadowsAreRightInTheMean) {
  SplatStage stage = make_box(24);
  SplatSettings settings;
  settings.coarsest = 1000;        // pixel by pixel
  settings.smooth_visibility = 0;  // each for itself
  settings.virtual_lights = 64;
  settings.shadow_rays = 64;  // a quarter for a single pixel
  stage.draw(settings);
  constexpr int passes = 64;
  constexpr int places[][2] = {{4, 18}, {12, 22}, {8, 12}, {16, 17}, {20, 6}, {12, 3}};
  Mean found[6][3];
  for (uint32_t pass = 0; pass < passes; pass++) {
    stage.splat(settings, {11 + 37 * pass, pass});
    for (int k = 0; k < 6; k++)
      for (int c = 0; c < 3; c++)
        found[k][c].add(
            double(stage.picture.irradiance[size_t(places[k][1] * 24 + places[k][0])][c]));
  }
  int shadowed = 0;
  for (int k = 0; k < 6; k++) {
    int x = places[k][0], y = places[k][1];
    dvec3 right =
        seen_light(stage, stage.place(x, y), stage.normal(x, y), stage.depth[size_t(y * 24 + x)]);
    dvec3 all = brute_force(stage.drawn.lights, stage.place(x, y), stage.normal(x, y));
    shadowed += right.x < 0.9 * all.x;
    for (int c = 0; c < 3; c++) expect_mean(found[k][c], right[c], "place", 0.1);
  }
  EXPECT_GE(shadowed, 2);
}

// If lights have one colour and nothing is in the way, nothing is left to chance.
TEST(SplatVisibility, WithoutShadowsNothingIsLeftToChance) {
  Scene scene = empty_scene();
  add_mesh(scene, box_mesh(add_material(scene, diffuse(vec3(0.5f))), vec3(2), true), "room");
  PunctualLight light;
  light.position = {0.2f, 0.1f, 0};
  scene.lights.push_back(light);
  // Askew, so that no pixel lies on an edge between walls.
  View view = make_view_towards(scene, {0.03, 0.07, 0.9}, {0, 0, 0}, {0, 1, 0}, 1.2f, 64, 64);
  SplatStage stage(std::move(scene), view);
  SplatSettings settings;
  stage.draw(settings);
  stage.splat(settings);
  RawVector<vec3> shadowed = stage.picture.irradiance;
  EXPECT_GT(stage.picture.counters.shadow_rays, 1000u);
  settings.visibility = false;
  stage.splat(settings);
  EXPECT_EQ(stage.picture.counters.shadow_rays, 0u);
  for (size_t i = 0; i < shadowed.size(); i++)
    ASSERT_NEAR(shadowed[i].x / stage.picture.irradiance[i].x, 1, 0.02) << i % 64 << ", " << i / 64;
}

TEST(SplatVisibility, BehindAWallItIsDark) {
  Scene scene = empty_scene();
  int white = add_material(scene, diffuse(vec3(0.5f)));
  add_mesh(scene, box_mesh(white, {6, 2, 2}, true), "room");
  add_mesh(scene, box_mesh(white, {0.1f, 2.2f, 2.2f}), "wall");
  PunctualLight light;
  light.position = {2, 0, 0};
  scene.lights.push_back(light);
  View view = make_view_towards(scene, {-0.5, 0, 0}, {-3, 0, 0}, {0, 1, 0}, 1.2f, 64, 64);
  SplatStage stage(std::move(scene), view);
  SplatSettings settings;
  stage.draw(settings);
  stage.splat(settings);
  double sum = 0;
  for (vec3 e : stage.picture.irradiance) sum += double(e.x);
  EXPECT_EQ(sum, 0);
  settings.visibility = false;
  stage.splat(settings);
  for (vec3 e : stage.picture.irradiance) sum += double(e.x);
  EXPECT_GT(sum, 1);
}

// Coarse subsplats at the border of a shadow are refined, and others are not.
TEST(SplatVisibility, RefinesWhereVisibilityChanges) {
  SplatStage stage = make_box(256);
  SplatSettings settings;
  stage.draw(settings);
  settings.probe_rays = 0;
  stage.splat(settings);
  uint64_t plain = stage.picture.counters.all_subsplats();
  EXPECT_EQ(stage.picture.counters.probe_rays, 0u);
  settings.probe_rays = 8;
  stage.splat(settings);
  uint64_t refined = stage.picture.counters.all_subsplats();
  EXPECT_GT(refined, plain + 100);
  EXPECT_LT(refined, 2 * plain);
  SplatStage empty = make_box(256, false);
  empty.draw(settings);
  settings.probe_rays = 0;
  empty.splat(settings);
  plain = empty.picture.counters.all_subsplats();
  settings.probe_rays = 8;
  empty.splat(settings);
  EXPECT_LT(empty.picture.counters.all_subsplats(), plain + plain / 20);
}
