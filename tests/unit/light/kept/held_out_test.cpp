// SPDX-License-Identifier: Apache-2.0
// A bake says how wrong it is.
#include "light/kept/held_out.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/light/kept/bake_cases.h"

namespace wellspring::test {
namespace {

using namespace scenes;

constexpr float cell = 0.2f;

// The error that places held out of a furnace tell of a map that is painted so; its light is 2.
float told_of(const test::PaintedLight& painted, int samples) {
  const Scene scene = make_furnace(0.5f);
  const World world(scene);
  const BakeScene lit = make_bake_scene_of_paths(world);
  const BakeCharts charts = make_charts(world, 4 * cell);
  HeldOut held = hold_out(world, charts, {}, 1024, 1);
  EXPECT_EQ(held.places.size(), 1024u);
  if (samples > 0) sample_held_out(lit, samples, held);
  return held_out_error(held, *test::paint_map(world, cell, {painted}));
}

TEST(HeldOut, NoiseOfItsSamplesIsNoError) {
  auto right = [](vec3) { return vec3(2); };
  EXPECT_EQ(told_of(right, 0), 1) << "nobody has looked";
  const float few = told_of(right, 1), many = told_of(right, 64);
  EXPECT_LT(few, 0.3f) << "a sample's own deviation is about its mean";
  EXPECT_LT(many, 0.04f);
  EXPECT_GT(many, 0);
}

TEST(HeldOut, WhatTheMapIsWrongByIsTold) {
  EXPECT_NEAR(told_of([](vec3) { return vec3(2.4f); }, 64), 0.2, 0.04);
  // Right on the mean, wrong by a half everywhere.
  auto wrong = [](vec3 p) {
    return vec3(2 + (std::sin(7 * p.x + 5 * p.y + 6 * p.z) > 0 ? 1.0f : -1.0f));
  };
  EXPECT_NEAR(told_of(wrong, 64), 0.5, 0.17);
}

// Nodes too wide for a shadow's edge: their own noise, none, does not tell.
TEST(HeldOut, WhatNodesAreTooCoarseForIsTold) {
  Scene scene = empty_scene();
  const vec3 bulb(0.3f, 1, -0.2f);
  test::add_fan(scene, add_material(scene, diffuse(vec3(0.5f))), {-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
  add_quad(scene, add_material(scene, diffuse(vec3(0))), {-0.25f, 0.45f, 0.25f}, {0.5f, 0, 0},
           {0, 0, -0.5f});
  scene.lights.push_back(test::point_light(bulb, vec3(4)));
  test::Baked baked(scene, {.gather_nodes = 400, .direct_nodes = 400});
  auto map = baked.map(4);
  ASSERT_TRUE(map);
  double squares = 0, sum = 0, count = 0;
  for (int k = 0; k < 128 * 128; k++, count++) {
    const vec3 place((float(k % 128) + 0.5f) / 64 - 1, 0, (float(k / 128) + 0.5f) / 64 - 1);
    const vec3 line = bulb - place;
    Ray ray;
    ray.origin = place + vec3(0, 1e-4f, 0), ray.direction = line, ray.t_max = 1;
    const double truth =
        baked.world.occluded(ray)
            ? 0
            : 4 * double(line.y) / std::pow(double(dot(line, line)), 1.5) / double(pi);
    const uint32_t chart = map->places->find(0, 0, true);
    const double known = double(eval_illumination(*map, map->places->charts[chart], place).x);
    squares += (known - truth) * (known - truth), sum += truth;
  }
  const double error = std::sqrt(squares / count) / (sum / count);
  EXPECT_GT(error, 0.1) << "there is something to tell";
  HeldOut held = hold_out(baked.world, baked.bake.charts, {}, 8192, 3);
  sample_held_out(baked.lit, 1, held);  // a point's light is not noisy
  EXPECT_NEAR(double(held_out_error(held, *map)), error, error / 5);
}

TEST(HeldOut, PlacesAreWhereEyesLook) {
  const Scene scene = make_furnace(0.5f);
  const World world(scene);
  const BakeCharts charts = make_charts(world, 0.5f);
  const vec3 eye(0.3f, -0.2f, 0.1f);
  const HeldOut held = hold_out(world, charts, std::span(&eye, 1), 200, 1);
  ASSERT_EQ(held.places.size(), 200u);
  for (const HeldOutPlace& place : held.places) {
    EXPECT_EQ(place.ray.origin, eye);
    EXPECT_LT(std::abs(place.ray.direction.y), 0.51f);
    EXPECT_LT(length(place.position - (eye + place.hit.t * place.ray.direction)), 1e-4f);
    EXPECT_NE(place.chart, no_chart);
  }
}

TEST(HeldOut, WhatIsRestoredMustBeOfTheWorld) {
  const Scene scene = make_furnace(0.5f);
  const World world(scene);
  const BakeCharts charts = make_charts(world, 0.5f);
  const HeldOut held = hold_out(world, charts, {}, 8, 1);
  HeldOut same = held;
  EXPECT_TRUE(restore(world, *charts.places, same));
  for (int what = 0; what < 5; what++) {
    HeldOut broken = held;
    HeldOutPlace& place = broken.places[5];
    if (what == 0) place.hit.instance = 7;
    if (what == 1) place.hit.triangle = 1u << 30;
    if (what == 2) place.hit.barycentric = {0.9f, 0.9f};
    if (what == 3) place.half[1] = NAN;
    if (what == 4) place.ray.direction = -place.ray.direction;
    EXPECT_FALSE(restore(world, *charts.places, broken)) << what;
  }
}

}  // namespace
}  // namespace wellspring::test
