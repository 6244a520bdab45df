// SPDX-License-Identifier: Apache-2.0
// Solid glass in a row, and what is seen through it, whatever the number of panes: what glass does
// is no edge of a path. Clear glass in white light is white; a lamp behind it is as bright as the
// stack lets through, all reflections to and fro included.
#include <algorithm>

#include "unit/light/statistics.h"
#include "unit/light/technique/slabs.h"

namespace wellspring::test {
namespace {

using namespace scenes;

// Panes of clear glass, a centimetre thick, one behind the other towards -Z.
void add_panes(Scene& scene, int count, float roughness = 0) {
  int clear = add_material(scene, glass(1.5f, roughness, 0.01f));
  for (int i = 0; i < count; i++)
    add_slab(scene, clear, -0.5f * float(i) - 0.01f, -0.5f * float(i), 6);
}
Scene white_panes(int count, float roughness = 0) {
  Scene scene = empty_scene();
  add_panes(scene, count, roughness);
  scene.environment.radiance = vec3(1);
  return scene;
}
const Ray along = ray_towards({0.1f, 0.23f, 3}, {0.12f, 0.2f, 0});

TransportSettings edges(int count) { return TransportSettings{.max_depth = count}; }

// Returns a picture's mean by any technique, also by one that draws passes with lights of its own.
Mean picture_mean(const Technique& technique, const Scene& scene, int max_depth) {
  World world(scene);
  Lights lights = make_lights(world);
  View view = make_view_towards(scene, {0.1, 0.23, 3}, {0.12, 0.2, 0}, {0, 1, 0}, 0.01f, 8, 8);
  if (technique.prepare) technique.prepare(world, std::span(&view.position, 1), lights);
  StillSettings settings{.spp = 24, .transport = edges(max_depth)};
  Mean mean;
  for (vec3 c : render_still(technique, world, lights, view, settings).color)
    mean.add(double(luminance(c)));
  return mean;
}

TEST(GlassRows, ClearPanesInWhiteAreWhiteByEveryTechnique) {
  for (const Technique& technique : techniques())
    for (int count : {1, 2, 4, 6, 10}) {
      Mean mean = picture_mean(technique, white_panes(count), 6);
      EXPECT_NEAR(mean.mean(), 1, count < 10 ? 0.03 : 0.05) << technique.name << ' ' << count;
    }
}

TEST(GlassRows, PanesThatAreNearlySmoothAreNearlyWhite) {
  for (int count : {2, 4, 6}) {
    Scene scene = white_panes(count, 0.1f);
    World world(scene);
    Mean mean = trace_mean("path", world, make_lights(world), along, 4096, edges(6));
    EXPECT_NEAR(mean.mean(), 1, 0.03) << count;
  }
}

TEST(GlassRows, ALampIsAsBrightAsTheStackLetsThrough) {
  const Ray ahead = ray_towards({0.1f, 0.23f, 3}, {0.1f, 0.23f, 0});
  for (int count : {1, 3, 6, 10}) {
    std::vector<Layer> layers;
    for (int i = 0; i < 2 * count; i++) layers.push_back({i % 2 ? 1.0 : 1.5, 1});
    Scene scene = empty_scene();
    add_panes(scene, count);
    add_wall(scene, emitter(vec3(1)), -9, 3, "quad");
    World world(scene);
    for (const char* technique : {"path", "direct", "gather"})
      expect_mean(trace_mean(technique, world, make_lights(world), ahead, 8192, edges(6)),
                  see_through(1, layers).passes, technique);
  }
}

TEST(GlassRows, ARoomBehindPanesIsLitAsDeepAsBeforeThem) {
  const float albedo = 0.5f;
  Scene bare = make_furnace(albedo), scene = bare;
  int clear = add_material(scene, glass(1.5f, 0, 0.01f));
  for (int i = 0; i < 6; i++)
    add_slab(scene, clear, -0.1f * float(i) - 0.01f, -0.1f * float(i), 1.9f);
  for (int depth : {4, 8}) {
    // The series has as many terms as there are edges.
    double expected = (1 - std::pow(double(albedo), depth)) / (1 - double(albedo));
    World world(scene);
    Ray ray = ray_towards({0, 0, 0.9f}, {0.1f, 0.05f, -1});
    Mean mean = trace_mean("path", world, make_lights(world), ray, 8192, edges(depth));
    EXPECT_NEAR(mean.mean(), expected, 0.02 * expected) << depth;
  }
}

// Water in glass in water, and the same again.
TEST(GlassRows, GlassInsideGlassCountsNoEdgesEither) {
  Scene scene = empty_scene();
  int clear = add_material(scene, glass(1.5f, 0, 1)),
      water = add_material(scene, glass(1.33f, 0, 1));
  std::vector<Layer> layers;
  for (float z : {0.0f, -1.5f}) {
    add_slab(scene, clear, z - 0.5f, z + 0.5f, 6);
    add_slab(scene, water, z - 0.3f, z + 0.3f, 5);
    add_slab(scene, clear, z - 0.1f, z + 0.1f, 4);
    for (double index : {1.5, 1.33, 1.5, 1.33, 1.5, 1.0}) layers.push_back({index, 1});
  }
  add_wall(scene, emitter(vec3(1)), -3, 9, "quad");
  World world(scene);
  const Ray ahead = ray_towards({0.1f, 0.23f, 3}, {0.1f, 0.23f, 0});
  for (int depth : {1, 2, 6})
    expect_mean(trace_mean("path", world, make_lights(world), ahead, 8192, edges(depth)),
                see_through(1, layers).passes, "nested");
}

// Mirrors and matt walls are counted as before: two edges are direct light.
TEST(GlassRows, WhatIsNoGlassIsCountedAsBefore) {
  Scene scene = make_furnace(0.5f);
  add_box(scene, glass(1.5f, 0, 1), vec3(0.5f), "block");
  World world(scene);
  Ray past = ray_towards({0.9f, 0.8f, 0.9f}, {1, 0.8f, 0.8f});
  Mean mean = trace_mean("path", world, make_lights(world), past, 8192, edges(2));
  EXPECT_NEAR(mean.mean(), 1.5, 0.02);
}

}  // namespace
}  // namespace wellspring::test
