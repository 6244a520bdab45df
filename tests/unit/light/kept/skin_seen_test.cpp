// SPDX-License-Identifier: Apache-2.0
// Light on what moves goes where it is seen, and keeps its form.
#include <gtest/gtest.h>

#include <cmath>

#include "light/kept/skin/skin_light.h"
#include "light/material/light_slope.h"
#include "unit/light/kept/skin_stage.h"

namespace wellspring::test {
namespace {

constexpr float radius = 0.1f;

// Neighbours' normals lie 7.5 degrees apart: as far as their cosines under a sun differ, smoothing
// knows it from the slope, and takes no contrast away.
TEST(SkinForm, SmoothingTakesNoContrast) {
  SkinStage stage = make_sphere_stage(radius);
  stage.scene.lights.push_back(make_sun());
  stage.scene.environment.radiance = vec3(0.05f);
  stage.begin();
  stage.skin.noise = 1;  // as though samples were noisy
  const int places = int(stage.skin.places.size());
  for (int i = 0; i < 4; i++) {
    stage.look(places, 1, 4);
    stage.skin.noise = 1;
  }
  double squares = 0, count = 0;
  for (uint32_t v = 0; v < uint32_t(stage.moving[0].positions.size()); v++) {
    const float cosine = stage.normal_at(v).y;
    if (cosine < 0.3f) continue;
    const double off = double(stage.light_at(v).x - 0.05f - cosine);
    squares += off * off, count++;
  }
  EXPECT_LT(std::sqrt(squares / count), 0.03);
}

TEST(SkinForm, LightOfTiltedNormalsIsTold) {
  SkinStage stage = make_sphere_stage(radius);
  stage.scene.lights.push_back(make_sun());
  stage.begin();
  stage.look(4 * int(stage.skin.places.size()), 8);
  int judged = 0;
  for (const uvec3& t : stage.moving[0].triangles) {
    const vec3 normal = stage.normal_at(t.x);
    if (normal.y < 0.5f) continue;
    const SkinTriangle skin = find_skin(stage.skin, stage.skin.first_instance, t, false);
    const vec3 tilted = normalize(normal + vec3(0.2f, 0, 0.1f));
    const float expected = std::max(tilted.y, 0.0f) / normal.y;
    EXPECT_NEAR(eval_slope(skin.slope, normal, tilted), expected, 0.08f);
    judged++;
  }
  EXPECT_GT(judged, 100);
}

TEST(SkinSight, CountsThePixelsThatShowIt) {
  SkinStage stage = make_sphere_stage(radius);
  scenes::add_quad(stage.scene, stage.add_lambert(), {-1, 0.5f, -1}, {2, 0, 0}, {0, 0, 2}, "wall");
  stage.begin();
  const vec3 below(0, -1.5f, 0), above(0, 1.5f, 0);
  const View view = stage.view_from(below, vec3(0), 200, 200);
  double pixels = 0;
  constexpr int turns = 50;
  for (int i = 0; i < turns; i++)
    pixels += double(see_skin(*stage.world, stage.skin, view, 64, uint64_t(i)).pixels) / turns;
  const double across = std::tan(std::asin(double(radius) / 1.5)) / double(view.tan_half_fov) * 100;
  const double expected = double(pi) * across * across;
  EXPECT_NEAR(pixels, expected, 0.05 * expected);
  for (uint32_t place : see_skin(*stage.world, stage.skin, view, 64, 1).places)
    EXPECT_LT(stage.normal_at(stage.skin.places[place].vertex).y, 0.2f);
  // Behind the wall, and behind the eye.
  EXPECT_EQ(see_skin(*stage.world, stage.skin, stage.view_from(above), 64, 1).pixels, 0);
  EXPECT_EQ(see_skin(*stage.world, stage.skin, stage.view_from(below, {0, -3, 0}), 64, 1).pixels,
            0);
}

// Teeth behind lips: a small plate, and a cover a millimetre before it that comes and goes.
struct CoveredPlate : SkinStage {
  std::vector<vec3> closed, open;
  CoveredPlate() {
    moving.resize(2);
    moving[0].material = moving[1].material = add_lambert();
    scenes::append_quad(moving[0], {-0.01f, 0, 0.01f}, {0.02f, 0, 0}, {0, 0, -0.02f});
    scenes::append_quad(moving[1], {-0.3f, 0.001f, 0.3f}, {0.6f, 0, 0}, {0, 0, -0.6f});
    scene.environment.radiance = vec3(1);
    closed = open = moving[1].positions;
    for (vec3& p : open) p += vec3(0.8f, 0, 0);
    begin();
  }
  void put(const std::vector<vec3>& cover) {
    world->move(1, cover, moving[1].normals);
    world->commit();
  }
};

TEST(SkinSight, WhatOpensIsLitAtOnce) {
  CoveredPlate stage;
  const View view = stage.view_from({0, 0.4f, 0});
  stage.update.views = std::span(&view, 1);
  stage.look(32, 40);  // shut for long
  stage.put(stage.open);
  stage.look(32, 2);
  EXPECT_NEAR(stage.light_at(0).x, 1, 0.15f);
  // Shut again, nothing of that is lost.
  stage.put(stage.closed);
  stage.look(32, 40);
  stage.put(stage.open);
  smooth_skin(*stage.world, stage.skin);
  EXPECT_NEAR(stage.light_at(0).x, 1, 0.15f);
}

TEST(SkinSight, MostSamplesGoWhereItIsSeen) {
  SkinStage stage = make_sphere_stage(radius);
  stage.scene.environment.radiance = vec3(1);
  stage.begin();
  const View view = stage.view_from({0, 1, 0});
  stage.update.views = std::span(&view, 1);
  const int places = int(stage.skin.places.size());
  stage.look(places / 10, 10);
  double above = 0, all = 0;
  for (int i = 0; i < places; i++) {
    const double asked = stage.skin.history[size_t(i)].asked;
    all += asked;
    if (stage.normal_at(stage.skin.places[size_t(i)].vertex).y > 0) above += asked;
  }
  EXPECT_EQ(all, double(places / 10 * 10));
  EXPECT_GT(above, 0.8 * all);
}

}  // namespace
}  // namespace wellspring::test
