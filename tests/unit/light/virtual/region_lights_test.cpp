// SPDX-License-Identifier: Apache-2.0
#include "light/virtual/region_lights.h"

#include <cstring>

#include "light/virtual/eye_light.h"
#include "light/virtual/instant_radiosity.h"
#include "light/virtual/virtual_lights.h"
#include "light/sample/pane_boxes.h"
#include "scenes/scenes.h"
#include "unit/light/statistics.h"

using namespace wellspring;

using namespace wellspring::test;
using namespace wellspring::scenes;
using namespace wellspring::test;

namespace {

double irradiance_by(const PointLight& light, vec3 place, vec3 normal) {
  vec3 line = light.position - place;
  double d2 = double(dot(line, line)), d = std::sqrt(d2);
  double here = double(dot(line, normal)) / d, there = -double(dot(line, light.normal)) / d;
  return here > 0 && there > 0 ? double(light.radiance.x) * here * there / d2 : 0;
}

double irradiance_of_sets(const InstantPass& pass, vec3 place, vec3 normal) {
  double sum = 0;
  for (const PointLight& light : pass.lights) sum += irradiance_by(light, place, normal);
  return sum / pass.sets();
}

TransportSettings few_of_many() {
  TransportSettings settings;
  settings.instant.places = 6, settings.instant.walks = 4, settings.instant.bounced = 12;
  settings.instant.candidates = 2;
  settings.instant.asked = 5;
  return settings;
}

}  // namespace

// The lights that a region asks are in the mean worth all lights, in every list, at a place that
// its probes see and at one that they do not; and they are as few as was wanted.
TEST(RegionLights, AreWorthAllLights) {
  Scene scene = make_cornell_box();
  World world(scene);
  Lights lights = make_lights(world);
  View view = make_view_towards(scene, {0, 0.27f, 1.3f}, {0, 0.27f, 0}, {0, 1, 0}, 0.6f, 40, 30);
  TransportSettings settings = few_of_many();
  const vec3 floor(0, 0.001f, 0.1f), ceiling(0.2f, 0.54f, -0.2f);
  for (int list : {0, 17}) {
    Mean on_floor, on_ceiling;
    double asked = 0;
    for (uint64_t seed = 0; seed < 300; seed++) {
      InstantPass pass = draw_instant_pass({world, *lights.tables}, settings, view, seed, 0);
      // Pixels of the bottom row in the middle see the floor.
      int region = region_of_pixel(pass, uint32_t(29 * 40 + 20));
      ASSERT_GE(region, 0);
      size_t cell = size_t(region * pass.lists() + list);
      double low = 0, high = 0;
      for (uint32_t k = pass.regions.first[cell]; k < pass.regions.first[cell + 1]; k++) {
        const RegionLight& one = pass.regions.lights[k];
        low += double(one.factor) * irradiance_by(pass.lights[one.light], floor, {0, 1, 0});
        high += double(one.factor) * irradiance_by(pass.lights[one.light], ceiling, {0, -1, 0});
        asked++;
      }
      on_floor.add(low - irradiance_of_sets(pass, floor, {0, 1, 0}));
      on_ceiling.add(high - irradiance_of_sets(pass, ceiling, {0, -1, 0}));
    }
    EXPECT_LE(std::abs(on_floor.mean()), significance_z * on_floor.error());
    EXPECT_LE(std::abs(on_ceiling.mean()), significance_z * on_ceiling.error());
    EXPECT_NEAR(asked / 300, 5, 0.6);  // a list gets one more or less
    // At places that the probes see, the choice is the better one: F-test, a ratio of variances of
    // 300 draws below 0.64 has probability 1e-4 if they were equal.
    double relative = on_floor.error() / 1, other = on_ceiling.error() / 1;
    EXPECT_LT(relative * relative, 0.64 * other * other);
  }
}

// The set may be so large that only a share of it is looked at.
TEST(RegionLights, ChoiceForOnePlaceIsWorthItsSet) {
  Scene scene = make_cornell_box();
  World world(scene);
  Lights lights = make_lights(world);
  View view = make_view_towards(scene, {0, 0.27f, 1.3f}, {0, 0.27f, 0}, {0, 1, 0}, 0.6f, 40, 30);
  for (int walks : {4, 64}) {
    TransportSettings settings = few_of_many();
    settings.instant.walks = walks;
    InstantPass pass = draw_instant_pass({world, *lights.tables}, settings, view, 5, 0);
    Bsdf bsdf;
    bsdf.normal = bsdf.geometric_normal = {0, 1, 0};
    bsdf.diffuse = vec3(0.5f);
    const vec3 floor(0.1f, 0.001f, 0.1f);
    double all = 0;
    for (uint32_t k = pass.first[3]; k < pass.first[4]; k++)
      all += irradiance_by(pass.lights[k], floor, {0, 1, 0});
    Mean mean;
    for (int i = 0; i < 4000; i++) {
      RegionLight chosen[16];
      Rng rng{uint64_t(i)};
      int count = choose_place_lights(pass, 3, floor, bsdf, 4, rng.uniform(), chosen);
      ASSERT_LE(count, 5);
      double sum = 0;
      for (int k = 0; k < count; k++)
        sum += double(chosen[k].factor) *
               irradiance_by(pass.lights[chosen[k].light], floor, {0, 1, 0});
      mean.add(sum);
    }
    expect_mean(mean, all, "four of a set");
  }
}

// A pixel at the edge of something bright shows the share that the thing covers, sooner than by one
// ray a pixel; far from edges nothing is done.
TEST(EdgeSamples, EdgesAreMeansOverTheirPixels) {
  Scene scene = empty_scene();
  int bright = add_material(scene, emitter(vec3(1)));
  add_mesh(scene, box_mesh(bright, {1, 2, 0.01f}), "sign", at({0, 0, -2}));
  World world(scene);
  Lights lights = make_lights(world);
  // The sign's right edge, at x = 0.5, crosses the middle column at 0.3 of its width.
  const float column = 1.995f * std::tan(0.25f) * 2 / 9;
  View view = make_view_towards(scene, {0.5f + 0.2f * column, 0, 0}, {0.5f + 0.2f * column, 0, -1},
                                {0, 1, 0}, 0.5f, 9, 9);
  StillSettings one, more;
  one.spp = more.spp = 1;
  one.transport.instant.edge_rays = 0;
  more.transport.instant.edge_rays = 15;
  Mean plain, refined;
  const Technique& instant = *find_technique("instant_radiosity");
  for (uint64_t seed = 0; seed < 60; seed++) {
    one.seed = more.seed = seed;
    Frame a = render_still(instant, world, lights, view, one),
          b = render_still(instant, world, lights, view, more);
    for (size_t y = 0; y < 9; y++) {
      plain.add(double(a.color[y * 9 + 4].x));
      refined.add(double(b.color[y * 9 + 4].x));
      EXPECT_EQ(b.color[y * 9 + 1].x, 1);
      EXPECT_EQ(b.color[y * 9 + 7].x, 0);
    }
  }
  expect_mean(plain, 0.3, "one ray", 0.2);
  expect_mean(refined, 0.3, "sixteen rays", 0.2);
  // Sixteen rays instead of one: F-test as above, 540 draws.
  EXPECT_LT(std::pow(refined.error() / plain.error(), 2), 0.7 / 16 * 1.5);
}

TEST(PaneBoxes, EveryOneOfManyPanesIsAsked) {
  for (int panes : {1, 7, 8, 9, 21}) {
    Scene scene = empty_scene();
    int pane = add_material(scene, glass(1.5f, 0, 0));
    auto place = [](int i) { return vec3(2.0f * float(i), 0, -2); };
    for (int i = 0; i < panes; i++)
      add_mesh(scene, box_mesh(pane, {1, 1, 0.01f}), "pane", at(place(i)));
    add_mesh(scene, box_mesh(add_material(scene, emitter(vec3(1))), vec3(1)), "lamp",
             at({0, 9, 0}));
    World world(scene);
    Lights lights = make_lights(world);
    auto crosses = [&](vec3 target) {
      Ray ray;
      ray.direction = target;
      ray.t_max = 1.5f;
      return may_cross_pane(lights.tables->pane_boxes, ray);
    };
    for (int i = 0; i < panes; i++) {
      EXPECT_TRUE(crosses(place(i))) << panes << ", " << i;
      EXPECT_FALSE(crosses(place(i) + vec3(0, 3, 0))) << panes << ", " << i;
    }
    EXPECT_FALSE(crosses(place(panes + 1)));
  }
}

TEST(PaneBoxes, RaysElsewhereAskNoPane) {
  Scene scene = empty_scene();
  int pane = add_material(scene, glass(1.5f, 0, 0)),
      wall = add_material(scene, diffuse(vec3(0.5f)));
  add_mesh(scene, box_mesh(pane, {1, 1, 0.01f}), "pane", at({0, 0, -2}));
  add_mesh(scene, box_mesh(wall, {1, 1, 0.01f}), "wall", at({3, 0, -2}));
  int lamp = add_material(scene, emitter(vec3(1)));
  add_mesh(scene, box_mesh(lamp, {1, 1, 0.01f}), "lamp", at({0, 0, -4}));
  World world(scene);
  Lights lights = make_lights(world);
  auto crosses = [&](vec3 origin, vec3 direction, float t_max) {
    Ray ray;
    ray.origin = origin, ray.direction = direction, ray.t_max = t_max;
    return may_cross_pane(lights.tables->pane_boxes, ray);
  };
  const float far = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(crosses({0, 0, 0}, {0, 0, -1}, far));
  EXPECT_TRUE(crosses({0, 0, -2}, {0, 0, -1}, far));  // from within
  EXPECT_TRUE(crosses({0, 0, 0}, {0, 0, -4}, 1));     // unit of t is not metres
  EXPECT_FALSE(crosses({0, 0, 0}, {0, 0, -1}, 1.9f));
  EXPECT_FALSE(crosses({0, 0, 0}, {0, 0, 1}, far));
  EXPECT_FALSE(crosses({3, 0, 0}, {0, 0, -1}, far));
  // A thing of the pane's that moves may be anywhere.
  Mesh moving = box_mesh(pane, {1, 1, 1});
  scene.objects.push_back("moving");
  World with(scene, {moving}, {uint32_t(scene.objects.size() - 1)});
  Lights all = make_lights(with);
  Ray ray;
  ray.origin = {9, 9, 9}, ray.direction = {0, 1, 0};
  EXPECT_TRUE(may_cross_pane(all.tables->pane_boxes, ray));
}
