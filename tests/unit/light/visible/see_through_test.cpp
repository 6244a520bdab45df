// SPDX-License-Identifier: Apache-2.0
// What is seen without light agrees with what a technique says of the same ray.
#include "light/visible/guides.h"

#include <cmath>

#include "light/technique/technique.h"
#include "scenes/lit_world.h"
#include "unit/light/statistics.h"

namespace wellspring::test {
namespace {

using namespace scenes;

// One of everything: Lambertian, glossy, mirror, rough metal, brushed, unlit, a lamp, a pane; and
// sky where there is no wall.
Scene make_assembly(bool solid) {
  Material brushed = metal({0.7f, 0.6f, 0.5f}, 0.3f), unlit = diffuse({0.3f, 0.8f, 0.2f});
  brushed.anisotropy = 0.8f;
  unlit.unlit = true;
  Scene scene =
      make_row_of_balls({diffuse({0.2f, 0.4f, 0.6f}), metal({0.9f, 0.8f, 0.6f}, 0),
                         metal({0.8f, 0.5f, 0.4f}, 0.6f), brushed, unlit, emitter({3, 2, 1})},
                        -2.5f);
  Material pane = glass(1.5f, 0, 0);
  pane.base_color = {0.5f, 0.9f, 0.7f, 1};
  add_quad(scene, pane, {-1.6f, -0.9f, 0}, {1.5f, 0, 0}, {0, 1.5f, 0}, "pane");
  if (solid) add_sphere(scene, glass(1.5f, 0, 1), 0.4f, "glass", at(vec3(1, 0.9f, -1)));
  return scene;
}

class See : public testing::TestWithParam<bool> {};

TEST_P(See, AgreesWithTheSamplesOfTechniques) {
  auto [scene, world, lights] = LitWorld(make_assembly(GetParam()));
  View view = make_view_towards(scene, {0, 0.3, 4}, {0, 0, 0}, {0, 1, 0}, 1.2f, 96, 54);
  std::vector<Ray> rays;
  for (int y = 0; y < view.height; y++)
    for (int x = 0; x < view.width; x++)
      rays.push_back(view_ray(view, float(x) + 0.5f, float(y) + 0.5f));
  std::vector<PrimaryHit> seen(rays.size());
  see(world, lights, rays, seen);
  TransportSettings emission;  // one edge: what is there without any light falling
  emission.max_depth = 1;
  const Technique& path = *find_technique("path");
  int nothing = 0, glowing = 0;
  for (size_t i = 0; i < rays.size(); i++) {
    Request request{.ray = rays[i]};
    Sample dark = path.trace(world, lights, emission, request),
           lit = path.trace(world, lights, {}, request);
    bool hit = lit.flags & sample_hit;
    ASSERT_EQ(seen[i].object, hit ? lit.object : 0) << i;
    nothing += !hit;
    // Solid glass adds no edge, so things behind it are seen there, too; glass shines by nothing.
    const bool glass = hit && scene.objects[seen[i].object] == "glass";
    const vec3 own = glass ? vec3(0) : dark.rest;
    glowing += hit && own != vec3(0);
    for (int c = 0; c < 3; c++) {
      EXPECT_NEAR(seen[i].glow[c], own[c], 1e-4f) << i;
      EXPECT_NEAR(seen[i].albedo[c], lit.albedo[c], 1e-4f) << i;
    }
    if (!hit) {
      EXPECT_TRUE(std::isinf(seen[i].distance)) << i;
      EXPECT_FALSE(seen[i].scatters) << i;
      continue;
    }
    EXPECT_NEAR(seen[i].distance, lit.distance, 1e-4f * lit.distance) << i;
    EXPECT_GT(dot(seen[i].normal, lit.normal), 0.99f) << i;
    if (!seen[i].scatters) {
      EXPECT_EQ(lit.radiance(), dark.rest) << i;
    }
  }
  EXPECT_GT(nothing, 100);
  EXPECT_GT(glowing, 50);
}

INSTANTIATE_TEST_SUITE_P(Scenes, See, testing::Values(false, true));

// A emitting pane before a emitting board: what each emits is light of the sample, and told by
// itself where other light falls there, too.
TEST(SeeRays, WhatPanesAndSurfacesEmitIsLightAndToldByItself) {
  Scene scene = empty_scene();
  Material pane = glass(1.5f, 0, 0), board = diffuse(vec3(0.5f));
  pane.base_color = {0.5f, 0.9f, 0.7f, 1};
  pane.emission = {0.3f, 0.2f, 0.1f};
  pane.double_sided = true;
  board.emission = {1, 2, 4};
  add_wall(scene, pane, -1, 1, "pane");
  add_wall(scene, board, -2, 1, "board");
  World world(scene);
  Lights lights = make_lights(world);
  Request request;
  request.ray.direction = {0, 0, -1};
  TransportSettings emission{.max_depth = 1};
  const Technique& path = *find_technique("path");
  Sample dark = path.trace(world, lights, emission, request),
         lit = path.trace(world, lights, {}, request);
  EXPECT_EQ(lit.object, dark.object);
  EXPECT_GT(lit.albedo.y, 0.1f);
  // Schlick's 4 % at both sides, and the colour.
  float through = 0.96f * 0.96f;
  for (int c = 0; c < 3; c++) {
    float wanted = pane.emission[c] + pane.base_color[c] * through * board.emission[c];
    EXPECT_NEAR(dark.rest[c], wanted, 0.05f * wanted) << c;
    EXPECT_EQ(lit.glow[c], dark.rest[c]) << c;
    EXPECT_GE(lit.rest[c], lit.glow[c]) << c;
  }
}

TEST(SeeRays, NoneAndBrokenOnesDoNoHarm) {
  auto [scene, world, lights] = LitWorld(make_assembly(false));
  see(world, lights, {}, {});
  Ray broken{.direction = vec3(NAN)};
  std::vector<Ray> rays(100, broken);
  std::vector<PrimaryHit> seen(rays.size());
  see(world, lights, rays, seen);
  for (const PrimaryHit& s : seen) EXPECT_EQ(s.object, 0u);
  EXPECT_THROW(see(world, lights, rays, std::span(seen).first(3)), std::invalid_argument);
}

}  // namespace
}  // namespace wellspring::test
