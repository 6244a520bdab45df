// SPDX-License-Identifier: Apache-2.0
// What places see of few lamps: learned right, and used without bias.
#include <gtest/gtest.h>

#include "light/kept/lamps.h"
#include "light/random/warp.h"
#include "light/sample/lamps_seen.h"
#include "light/sample/lights.h"
#include "light/sample/sample_light.h"
#include "scenes/scenes.h"
#include "unit/light/statistics.h"

namespace wellspring::test {
namespace {

enum RoofLamp : size_t { sun, below, above, lamps };

// A floor, 2 m above it a roof over its middle, a lamp below and one above that, and the sun
// upright.
Scene roofed_floor() {
  Scene scene = scenes::empty_scene();
  int white = scenes::add_material(scene, scenes::diffuse(vec3(0.5f)));
  scenes::add_quad(scene, white, {-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, "floor");
  scenes::add_quad(scene, white, {-2, 2, -2}, {4, 0, 0}, {0, 0, 4}, "roof");
  scene.lights.resize(lamps);
  scene.lights[sun].type = PunctualType::directional;
  scene.lights[sun].direction = {0, -1, 0};
  scene.lights[sun].intensity = vec3(5);
  scene.lights[below].position = {0, 1.5f, 0};
  scene.lights[above].position = {0, 5, 0};
  for (size_t lamp : {below, above}) scene.lights[lamp].intensity = vec3(3);
  return scene;
}

struct Place {
  Scene scene = roofed_floor();
  World world{scene};
  Lights lights = make_lights(world);
  vec3 eye{0.3f, 1, 0.2f};
  Transport transport{world, *lights.tables};
  std::shared_ptr<const LampsSeen> seen =
      learn_lamps_seen(transport, std::span(&eye, 1), {.cell = 0.5f});
};

SurfacePlace on_floor(float x, float z) { return SurfacePlace{.position = {x, 0, z}, .extent = 4}; }

// Averages the light that arrives from a drawn lamp, over many draws.
Mean estimate_seen(const Place& p, const LampsSeen* lamps, const SurfacePlace& place, int count) {
  Transport transport{p.world, *p.lights.tables, nullptr, lamps};
  Mean mean;
  Sampler sampler(11);
  for (int i = 0; i < count; i++) {
    LightSample light = sample_punctual_light(transport, place, {0, 1, 0}, false, sampler);
    float cosine = std::max(dot(light.direction, vec3(0, 1, 0)), 0.0f);
    mean.add(light.pdf > 0 ? double(cosine * luminance(light.radiance *
                                                       eval_visibility(transport, place, light)))
                           : 0);
  }
  return mean;
}

double exact(const Place& p, const SurfacePlace& place) {
  double sum = 0;
  for (size_t i = 0; i < lamps; i++) {
    Scene alone = p.scene;
    alone.lights = {p.scene.lights[i]};
    World world(alone);
    Lights lights = make_lights(world);
    Transport transport{world, *lights.tables};
    Sampler sampler(1);
    LightSample light = sample_punctual_light(transport, place, {0, 1, 0}, false, sampler);
    sum += double(light.direction.y *
                  luminance(light.radiance * eval_visibility(transport, place, light)));
  }
  return sum;
}

TEST(LampsSeen, SharesAreWhatArrives) {
  Place p;
  ASSERT_TRUE(p.seen);
  auto share = [&](vec3 place, vec3 normal, RoofLamp lamp) {
    const LampsSeen::Shares* shares = find_lamps_seen(*p.seen, place, normal);
    return shares ? float((*shares)[lamp]) / 255 : -1;
  };
  vec3 up(0, 1, 0), down(0, -1, 0);
  for (vec3 roofed : {vec3(0.2f, 0, 0.2f), vec3(-1.2f, 0, 0.7f)}) {
    EXPECT_LT(share(roofed, up, sun), 0.05f);
    EXPECT_LT(share(roofed, up, above), 0.05f);
    EXPECT_GT(share(roofed, up, below), 0.95f);
    EXPECT_GT(share(roofed, up, sun), 0.0f) << "it may shine there one day";
  }
  EXPECT_GT(share({3.3f, 0, 3.3f}, up, sun), 0.9f);
  EXPECT_GT(share({3.8f, 0, 3.8f}, up, above), 0.7f);
  EXPECT_GT(share({0.2f, 2, 0.2f}, down, below), 0.95f);
  EXPECT_EQ(find_lamps_seen(*p.seen, {0.2f, 7, 0.2f}, up), nullptr);
}

TEST(LampsSeen, TheChoiceByThemIsUnbiasedAndLessNoisy) {
  Place p;
  for (SurfacePlace place :
       {on_floor(0.2f, 0.2f), on_floor(1.9f, 0.3f), on_floor(2.1f, 0.3f), on_floor(3.3f, 3.3f)}) {
    double expected = exact(p, place);
    Mean with = estimate_seen(p, p.seen.get(), place, 20000),
         without = estimate_seen(p, nullptr, place, 20000);
    expect_mean(with, expected, "by lamps seen", 0.05);
    expect_mean(without, expected, "by effects alone", 0.05);
    if (place.position.x < 1) {
      EXPECT_LT(with.error(), 0.4 * without.error());
    }
  }
}

// A door is opened: what was learned is wrong by far, and still nothing is lost.
TEST(LampsSeen, WhatWasNeverSeenIsStillFound) {
  Place p;
  SurfacePlace place = on_floor(3.3f, 3.3f);
  LampsSeen wrong = *p.seen;
  for (LampsSeen::Shares& shares : wrong.shares)
    shares[sun] = shares[above] = 1, shares[below] = 255;
  expect_mean(estimate_seen(p, &wrong, place, 400000), exact(p, place), "learned wrong", 0.05);
}

// While a lamp is switched off the others are known as before, though their places in the list
// change.
TEST(LampsSeen, SwitchedOffLampsLeaveTheOthersTheirShares) {
  Place p;
  EmittingSources emitting = find_emitting(p.world);
  emitting.lights[below] = vec3(0);
  std::shared_ptr<const LightTables> fewer = relit(*p.lights.tables, p.scene, emitting);
  ASSERT_EQ(fewer->punctual.size(), 2u);
  LampsSeen alike = *p.seen, uneven = alike;
  for (LampsSeen::Shares& shares : alike.shares) shares.fill(255);
  for (LampsSeen::Shares& shares : uneven.shares) shares.fill(255), shares[below] = 1;
  int near = 0;
  for (uint64_t seed = 1; seed <= 200; seed++) {
    Sampler one(seed), other(seed);
    SurfacePlace place = on_floor(3.3f, 3.3f);
    LightSample a =
        sample_punctual_light({p.world, *fewer, nullptr, &alike}, place, {0, 1, 0}, false, one);
    LightSample b =
        sample_punctual_light({p.world, *fewer, nullptr, &uneven}, place, {0, 1, 0}, false, other);
    EXPECT_EQ(a.share, b.share);
    EXPECT_EQ(a.direction, b.direction);
    near += std::isfinite(a.distance);
  }
  EXPECT_GT(near, 0);
  EXPECT_LT(near, 200);
}

TEST(LampsSeen, TheSameEachTimeAndNoneWhereThereIsNoChoice) {
  Place p, q;
  EXPECT_EQ(p.seen->keys, q.seen->keys);
  EXPECT_EQ(p.seen->shares, q.seen->shares);
  Scene one = roofed_floor();
  one.lights.resize(1);
  World world(one);
  Lights lights = make_lights(world);
  EXPECT_EQ(learn_lamps_seen({world, *lights.tables}, std::span(&p.eye, 1)), nullptr);
  EXPECT_EQ(learn_lamps_seen(p.transport, {}), nullptr);
}

}  // namespace
}  // namespace wellspring::test
