// SPDX-License-Identifier: Apache-2.0
// Walks that end on light that is known: the technique `gather` against the reference.
#include <gtest/gtest.h>

#include <cmath>

#include "light/kept/finish_bake.h"
#include "light/random/warp.h"
#include "light/technique/technique.h"
#include "light/walk/known_light.h"
#include "light/walk/walk.h"
#include "scenes/lit_world.h"

namespace wellspring::test {
namespace {

dvec3 mean_of(const Frame& frame) {
  dvec3 sum(0);
  for (vec3 c : frame.color) sum += dvec3(c);
  return sum / double(frame.color.size());
}

struct Prepared {
  Scene scene;
  World world;
  Lights lights;
  explicit Prepared(Scene scene_, vec3 place)
      : scene(std::move(scene_)), world(scene), lights(make_lights(world)) {
    find_technique("gather")->prepare(world, std::span(&place, 1), lights);
  }
};

// Walks end on the light that a path tracer finds at the same places.
TEST(Gather, KeptLightIsWhatThePathTracerFinds) {
  Prepared p(scenes::make_cornell_box(), vec3(0, 0.27f, 0.3f));
  ASSERT_TRUE(p.lights.known);
  const Transport keeps{p.world, *p.lights.tables, p.lights.known.get()};
  const Transport transport{p.world, *p.lights.tables};
  double kept_sum = 0, traced_sum = 0;
  int asked = 0;
  Rng rng(5);
  for (int i = 0; i < 6000; i++) {
    Walk walk;
    walk.ray.origin = vec3(0, 0.27f, -0.1f);
    walk.ray.direction = sample_sphere({rng.uniform(), rng.uniform()});
    walk.pdf = 1 / (4 * pi);
    const Hit hit = p.world.intersect(walk.ray);
    vec3 light;
    if (!hit.valid() || !find_kept_light(keeps, walk.ray, hit, false, light)) continue;
    if (max_component(p.world.material_of(hit.instance).emission) > 0) continue;
    asked++;
    kept_sum += luminance(vec3(p.world.material_of(hit.instance).base_color) * light);
    Sampler sampler(uint64_t(i) + 1000);
    traced_sum += luminance(follow(transport, WalkRules{.max_depth = 6}, walk, sampler));
  }
  EXPECT_GT(asked, 3000);
  EXPECT_NEAR(kept_sum / traced_sum, 1, 0.06);
}

TEST(Gather, AgreesWithPathInTheCornellBox) {
  Prepared p(scenes::make_cornell_box(), vec3(0, 0.27f, 0.3f));
  View view = scenes::cornell_view(p.scene, 48, 48);
  StillSettings settings{.spp = 64};
  dvec3 reference =
      mean_of(render_still(*find_technique("path"), p.world, p.lights, view, settings));
  dvec3 gathered =
      mean_of(render_still(*find_technique("gather"), p.world, p.lights, view, settings));
  for (int c = 0; c < 3; c++) EXPECT_NEAR(gathered[c] / reference[c], 1, 0.04);
}

// A small lamp and a polished ball: walls find the ball's highlight now and then, and each time are
// dazzled. In `gather` surfaces that a wide ray meets are blunter: a bias in how that light is
// spread, for a smaller error.
TEST(Gather, HighlightsMetByChanceAreNoSparks) {
  Scene scene = scenes::make_cornell_box();
  scene.materials[3].emission = vec3(0);  // its lamp
  scene.lights.push_back({.position = {0.1f, 0.5f, -0.1f}, .intensity = vec3(0.2f)});
  int gold = scenes::add_material(scene, scenes::metal({1, 0.8f, 0.4f}, 0.15f));
  scenes::add_mesh(scene, scenes::sphere_mesh(gold, 0.07f), "ball",
                   scenes::at({0.1f, 0.3f, -0.1f}));
  Prepared p(std::move(scene), vec3(0, 0.27f, 0.3f));
  View view = scenes::cornell_view(p.scene, 24, 24);
  StillSettings settings{.spp = 2048};
  Frame truth = render_still(*find_technique("path"), p.world, p.lights, view, settings);
  settings.seed = 2;
  settings.spp = 16;
  auto error_of = [&](const char* technique, double& mean) {
    Frame frame = render_still(*find_technique(technique), p.world, p.lights, view, settings);
    double sum = 0;
    for (size_t i = 0; i < frame.color.size(); i++) {
      double off = luminance(frame.color[i]) - luminance(truth.color[i]),
             there = luminance(truth.color[i]);
      sum += off * off / (there * there + 1e-4);
    }
    mean = luminance(vec3(mean_of(frame))) / luminance(vec3(mean_of(truth)));
    return sum / double(frame.color.size());
  };
  double path_mean, gather_mean;
  double path_error = error_of("path", path_mean), gather_error = error_of("gather", gather_mean);
  EXPECT_LT(gather_error, 0.8 * path_error);
  EXPECT_NEAR(gather_mean, 1, 0.04);
}

TEST(Gather, WhereNothingIsKnownItIsPathBitForBit) {
  auto [scene, world, lights] = scenes::LitWorld(scenes::make_cornell_box());
  View view = scenes::cornell_view(scene, 16, 16);
  StillSettings settings{.spp = 2};
  Frame a = render_still(*find_technique("path"), world, lights, view, settings);
  Frame b = render_still(*find_technique("gather"), world, lights, view, settings);
  EXPECT_EQ(a.color, b.color);
}

TEST(Gather, NoPlacesNoGeometryNoHarm) {
  auto [scene, world, lights] = scenes::LitWorld(scenes::empty_scene());
  vec3 place(0);
  find_technique("gather")->prepare(world, {}, lights);
  find_technique("gather")->prepare(world, std::span(&place, 1), lights);
  StillSettings settings{.spp = 1};
  View view;
  Frame frame = render_still(*find_technique("gather"), world, lights, view, settings);
  EXPECT_EQ(frame.color[0], vec3(0));
}

TEST(Gather, MirrorsKeepNoLight) {
  Scene scene = scenes::make_cornell_box();
  int mirror = scenes::add_material(scene, scenes::metal(vec3(0.9f), 0.05f));
  scenes::add_quad(scene, mirror, {-0.27f, 0.3f, -0.1f}, {0, 0, -0.2f}, {0, 0.2f, 0}, "mirror");
  Prepared p(std::move(scene), vec3(0, 0.27f, 0.3f));
  const Transport transport{p.world, *p.lights.tables, p.lights.known.get()};
  auto ask = [&](vec3 direction) {
    const Ray ray{.origin = {0, 0.27f, 0.1f}, .direction = normalize(direction)};
    const Hit hit = p.world.intersect(ray);
    vec3 light;
    return hit.valid() && find_kept_light(transport, ray, hit, false, light);
  };
  EXPECT_TRUE(ask({1, 0.2f, -1}));
  EXPECT_FALSE(ask({-0.27f, 0.13f, -0.3f}));
}

// A ball before a wall shades it, which a mirror would show and a wide ray does not.
TEST(Gather, WhereSomethingMovesOnlyWideRaysEnd) {
  Scene scene = scenes::make_cornell_box();
  Mesh ball = scenes::sphere_mesh(0, 0.05f);
  for (vec3& at : ball.positions) at += vec3(0.2f, 0.2f, -0.2f);
  const World still(scene), world(scene, {ball}, {0});
  const Lights lights = make_lights(world);
  const vec3 place(0, 0.27f, 0.3f);
  const auto known = make_bake_scene(still, std::span(&place, 1), {.nodes = 2000}).known;
  const Transport transport{world, *lights.tables, known.get()};
  const Ray ray{.origin = {0, 0.3f, -0.2f}, .direction = {1, 0, 0}};
  const Hit hit = world.intersect(ray);
  vec3 light;
  EXPECT_TRUE(find_kept_light(transport, ray, hit, false, light));
  EXPECT_FALSE(find_kept_light(transport, ray, hit, true, light));
}

// A polished metal shows the wall behind the viewer, whose light is known: no noise.
TEST(Gather, AMirrorShowsKeptLightWithoutNoise) {
  Scene scene = scenes::make_cornell_box();
  int mirror = scenes::add_material(scene, scenes::metal(vec3(0.9f), 0));
  scenes::add_quad(scene, mirror, {-0.2f, 0.1f, -0.3f}, {0.4f, 0, 0}, {0, 0.3f, 0}, "mirror");
  Prepared p(std::move(scene), vec3(0, 0.27f, 0.3f));
  const Transport transport{p.world, *p.lights.tables, p.lights.known.get()};
  WalkRules rules{.reads_maps = true};
  auto look = [&](uint64_t seed) {
    Request request;
    request.ray.origin = vec3(-0.2f, 0.25f, 0);
    request.ray.direction = normalize(vec3(1, -0.08f, -1));
    request.seed = seed;
    return trace_sample(transport, rules, request).radiance();
  };
  EXPECT_GT(luminance(look(1)), 0);
  EXPECT_EQ(look(1), look(2));
}

}  // namespace
}  // namespace wellspring::test
