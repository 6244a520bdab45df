// SPDX-License-Identifier: Apache-2.0
// Light that glass keeps ends all the same: by Russian roulette, and by a bound that nothing
// exceeds. Rays are counted, and only what meets glass pays.
#include <algorithm>
#include <cstring>

#include "light/walk/light_walk.h"
#include "light/walk/walk.h"
#include "scenes/lit_world.h"
#include "unit/light/statistics.h"
#include "unit/light/technique/slabs.h"

namespace wellspring::test {
namespace {

using namespace scenes;

// Slanting so towards all faces of a block of glass that it is totally reflected by each of them.
const vec3 slanting = normalize(vec3(0.6f, 0.55f, -0.58f));

Scene block_in_light(float keeps_per_metre) {
  Scene scene = empty_scene();
  add_box(scene, tinted_glass(1.5f, double(keeps_per_metre)), vec3(1), "block");
  scene.environment.radiance = vec3(1);
  return scene;
}
Ray inside_block() { return Ray{.origin = {0.1f, -0.07f, 0.03f}, .direction = slanting}; }

struct Counted {
  uint64_t most = 0, all = 0;
  Mean light;
};
Counted count_rays(const World& world, const Lights& lights, Ray ray, int samples) {
  Counted counted;
  WalkRules rules;
  Transport transport{world, *lights.tables};
  trace_sample(transport, rules, {ray});  // the media around the eye are found once
  for (int i = 0; i < samples; i++) {
    Request request{.ray = ray, .seed = sample_seed(3, 0, 0, uint32_t(i))};
    const uint64_t before = rays_traced();
    counted.light.add(double(luminance(trace_sample(transport, rules, request).radiance())));
    const uint64_t rays = rays_traced() - before;
    counted.most = std::max(counted.most, rays);
    counted.all += rays;
  }
  return counted;
}

TEST(GlassTrapped, TotalReflectionEndsByRoulette) {
  Scene scene = block_in_light(1);
  World world(scene);
  Counted counted = count_rays(world, make_lights(world), inside_block(), 512);
  EXPECT_EQ(counted.light.mean(), 0);
  EXPECT_LE(counted.most, uint64_t(most_glass + 1));
  // Twenty more on average, beyond those that nothing takes.
  EXPECT_NEAR(double(counted.all) / 512, sure_glass + 20, 4);
}

TEST(GlassTrapped, DarkGlassEndsSooner) {
  Scene scene = block_in_light(0.2f);
  World world(scene);
  Counted counted = count_rays(world, make_lights(world), inside_block(), 512);
  EXPECT_LT(double(counted.all) / 512, 24);
}

TEST(GlassTrapped, LightFromALampEndsToo) {
  auto [scene, world, lights] = LitWorld(block_in_light(1));
  Transport transport{world, *lights.tables};
  for (uint32_t i = 0; i < 64; i++) {
    Sampler sampler(5, i);
    LightWalk walk{.ray = inside_block(), .flux = vec3(1)};
    Arrival arrival;
    int steps = 0;
    while (arrive(transport, walk, arrival) &&
           scatter(walk, arrival, sample_bsdf(arrival.bsdf, Lobes::all, sampler), sampler))
      steps++;
    EXPECT_LE(steps, most_glass);
    EXPECT_EQ(walk.depth, 1);
  }
}

TEST(GlassTrapped, TwoHundredPanesEndAndStayWithinWhite) {
  Scene scene = empty_scene();
  int clear = add_material(scene, glass(1.5f, 0, 0.01f));
  for (int i = 0; i < 200; i++)
    add_slab(scene, clear, -0.05f * float(i) - 0.01f, -0.05f * float(i), 6);
  scene.environment.radiance = vec3(1);
  World world(scene);
  Counted counted =
      count_rays(world, make_lights(world), ray_towards({0.1f, 0.2f, 3}, {0.1f, 0.2f, 0}), 512);
  EXPECT_LE(counted.most, uint64_t(most_glass + 8 * 2));
  EXPECT_LT(double(counted.all) / 512, 80);
  EXPECT_GT(counted.light.mean(), 0.55);  // a third stays longer than the bound
  EXPECT_LT(counted.light.mean(), 1.03);
}

TEST(GlassTrapped, FaintestLightEndsAtOnceAndStaysFinite) {
  auto [scene, world, lights] = LitWorld(block_in_light(1));
  Transport transport{world, *lights.tables};
  for (float faint : {1e-30f, 1e-42f, 0x1p-149f}) {
    uint64_t before = rays_traced();
    for (uint32_t i = 0; i < 32; i++) {
      Walk walk{.ray = inside_block()};
      walk.ray.direction = {0, 0, -1};
      walk.throughput = vec3(faint);
      walk.glass = 20;  // has been through some
      walk.media.here = find_media(transport, walk.ray.origin);
      Sampler sampler(9, i);
      vec3 light = follow(transport, {}, walk, sampler);
      EXPECT_TRUE(is_finite(light)) << faint;
      EXPECT_LE(max_component(light), 4) << faint;
    }
    EXPECT_LE(rays_traced() - before, 32u * 2u + 64u) << faint;
  }
}

TEST(GlassTrapped, OnlyWhatMeetsGlassPays) {
  Scene bare = empty_scene();
  add_wall(bare, diffuse(vec3(0.6f)), -2, 4, "quad");
  bare.lights.push_back({.type = PunctualType::directional,
                         .direction = normalize(vec3(-0.2f, -0.3f, -1)),
                         .intensity = vec3(2)});
  Scene glazed = bare;
  int clear = add_material(glazed, glass(1.5f, 0, 0.01f));
  for (int i = 0; i < 6; i++)
    add_mesh(glazed, box_mesh(clear, {1, 8, 0.01f}), "pane", at({-3, 0, -0.1f * float(i)}));
  World without(bare), with(glazed);
  Lights dark = make_lights(without), lights = make_lights(with);
  auto cost = [&](const World& world, const Lights& own, vec3 target, vec3& seen) {
    WalkRules rules;
    Request request{.ray = ray_towards({target.x, 0, 3}, target), .seed = 11};
    uint64_t before = rays_traced();
    seen = trace_sample({world, *own.tables}, rules, request).radiance();
    return rays_traced() - before;
  };
  vec3 a, b;
  EXPECT_EQ(cost(without, dark, {2, 0.1f, -2}, a), cost(with, lights, {2, 0.1f, -2}, b));
  EXPECT_EQ(std::memcmp(&a, &b, sizeof a), 0);
  EXPECT_GT(luminance(a), 0.1f);
  EXPECT_GT(cost(with, lights, {-3, 0.1f, -2}, b), cost(without, dark, {-3, 0.1f, -2}, a));
}

}  // namespace
}  // namespace wellspring::test
