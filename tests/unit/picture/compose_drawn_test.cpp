// SPDX-License-Identifier: Apache-2.0
// Pictures that are drawn: with few points the light is a guess, but shapes and reflectances are
// exact.
#include "picture/compose_drawn.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "frame/tonemap.h"
#include "judge/compare.h"
#include "judge/flip.h"
#include "unit/picture/drawn_visit.h"

namespace wellspring::test {
namespace {

using namespace scenes;

constexpr int width = 160, height = 120, pixels = width * height;

// A box with a picture on its back wall and thin dark bars before it.
Scene make_room() {
  Scene scene = make_barred_box(vec3(0.1f), 0.004f);
  Image image{.width = 32, .height = 32};
  for (int i = 0; i < 32 * 32; i++)
    for (uint8_t c : {(i / 2 + i / 64) % 2 ? 220 : 30, 120, 60, 255}) image.texels8.push_back(c);
  Material picture = diffuse(vec3(1));
  picture.base_color_texture.texture = add_texture(scene, image);
  add_quad(scene, picture, {-0.2f, 0.2f, -0.54f}, {0.4f, 0, 0}, {0, 0.3f, 0}, "picture");
  return scene;
}
Stage make_room_with_ball() {
  Scene scene = make_room();
  Mesh ball = add_ball(scene, {0, 0.1f, 0});
  return Stage(std::move(scene), std::move(ball));
}
// Light that no surface is needed for: a lamp before a bright sky.
Scene make_emitting() {
  Scene scene = empty_scene();
  scene.environment.radiance = vec3(0.5f, 1, 2);
  add_wall(scene, emitter(vec3(3, 2, 1)), -4, 1, "lamp");
  return scene;
}
View view_from(const Stage& stage, double x, int width, int height) {
  return make_view(stage.scene, {x, 0.25, 0.6}, 0, 0, 0.7f, width, height);
}

// At rest a pixel may show whatever some place of it does.
int count_wrong_at_rest(const Stage& stage, const View& view, const Frame& frame) {
  constexpr vec2 places[] = {{0.5f, 0.5f},   {0.02f, 0.02f}, {0.98f, 0.02f}, {0.02f, 0.98f},
                             {0.98f, 0.98f}, {0.02f, 0.5f},  {0.98f, 0.5f},  {0.25f, 0.5f},
                             {0.75f, 0.5f},  {0.5f, 0.02f},  {0.5f, 0.98f}};
  return count_wrong(stage, view, frame, places);
}

void expect_light(const Frame& frame) {
  for (vec3 c : frame.color) ASSERT_TRUE(is_finite(c) && c.x >= 0 && c.y >= 0 && c.z >= 0);
}

// A picture drawn for the eye at once is the frame, tone-mapped; along edges light is mixed by the
// tone-mapped codes.
void expect_same_for_the_eye(DrawnVisit& drawn, const View& view,
                             const VisibilityPass& visibility) {
  for (float exposure : {1.0f, 3.5f}) {
    Image8 expected, shown, alone;
    std::vector<float> depth;
    tonemap(drawn.frame, {exposure}, expected);
    drawn.compositor.draw(drawn.cache, view, visibility, Tonemap{exposure}, shown, &depth);
    drawn.compositor.draw(drawn.cache, view, visibility, Tonemap{exposure}, alone);
    EXPECT_EQ(shown.width, view.width);
    EXPECT_EQ(shown.height, view.height);
    EXPECT_EQ(depth, drawn.frame.depth);
    EXPECT_EQ(alone.rgb, shown.rgb);
    ASSERT_EQ(shown.rgb.size(), expected.rgb.size());
    std::vector<bool> mixed(depth.size(), false);
    for (const auto& list : visibility.see_edges(view, vec2(0.5f), [](const VisibleRun&) {}))
      for (const EdgeShare& edge : list) mixed[edge.pixel] = true;
    EXPECT_LT(std::count(mixed.begin(), mixed.end(), true), ptrdiff_t(mixed.size() / 8));
    for (size_t i = 0; i < shown.rgb.size(); i++)
      ASSERT_NEAR(shown.rgb[i], expected.rgb[i], mixed[i / 3] ? 6 : 1)
          << "byte " << i << ", exposure " << exposure;
  }
}

// Halfway the view leaps to a place without points; odd sizes too: tiles and blocks end anywhere.
TEST(Drawn, MovingPicturesHaveExactShapesWithFewPoints) {
  for (ivec2 size : {ivec2(160, 120), ivec2(151, 97)}) {
    Stage stage = make_room_with_ball();
    DrawnVisit drawn;
    int count = size.x * size.y;
    View view;
    for (int i = 0; i < 24; i++) {
      stage.push_ball(0.004f);
      view = view_from(stage, 0.002 * i + (i >= 12 ? 0.1 : 0), size.x, size.y);
      drawn.step(stage, view, count / 60, PictureOf::moving);
    }
    ASSERT_EQ(drawn.frame.color.size(), size_t(count));
    expect_same_for_the_eye(drawn, view, *stage.visibility);
    EXPECT_LT(count_wrong(stage, view, drawn.frame), count / 1000);
    for (size_t i = 0; i < drawn.frame.object.size(); i++)
      ASSERT_EQ(drawn.frame.object[i] == 0, std::isinf(drawn.frame.depth[i])) << i;
    EXPECT_LT(rmse(drawn.frame, stage.truth(view, 32)), 0.21) << size.x;
    expect_light(drawn.frame);
  }
}

// A lattice of dark bars, two pixels wide, before a sky ten times as bright as white: what is left
// of the sky in a pixel is more than the bar.
TEST(Drawn, DarkBarsBeforeABrightSkyAreThoseOfAllOfThePixel) {
  Scene scene = empty_scene();
  scene.environment.radiance = vec3(9, 10, 11);
  int lead = add_material(scene, diffuse(vec3(0.02f)));
  for (int i = 0; i < 24; i++)
    for (float lean : {-0.7f, 0.4f})
      add_quad(scene, lead, {-1.6f + 0.13f * float(i) - lean, -1, -1.5f}, {0.016f, 0, 0},
               {2 * lean, 2, 0}, "lead");
  Stage stage(std::move(scene));
  DrawnVisit visit;
  View view = make_view(stage.scene, {0, 0, 0}, 0, 0, 0.7f, width, height);
  for (int i = 0; i < 12; i++) visit.step(stage, view, pixels / 8, PictureOf::moving);
  Image8 shown, expected;
  visit.compositor.draw(visit.cache, view, *stage.visibility, Tonemap{1}, shown);
  tonemap(stage.truth(view, 256), {1}, expected);
  double error = 0, dark = 0;
  for (size_t i = 0; i < shown.rgb.size(); i++) {
    error += std::abs(shown.rgb[i] - expected.rgb[i]) / double(shown.rgb.size());
    dark += (expected.rgb[i] < 128) / double(shown.rgb.size());
  }
  EXPECT_GT(dark, 0.01);
  EXPECT_LT(error, 9);
}

// Surroundings have a larger image for as long as they are drawn, and no more points.
TEST(Drawn, SurroundingsCostNoPoint) {
  Stage stage(make_room());
  DrawnVisit drawn;
  View view = view_from(stage, 0, width, height), around = view;
  around.width += 64, around.height += 32;
  around.tan_half_fov *= float(around.height) / float(view.height);
  drawn.cache.resize(width, height);
  auto step = [&](const View& seen, PictureOf kind, int budget) {
    drawn.sample_within(stage, seen, budget);
    drawn.cache.remember(seen, drawn.requests, drawn.samples);
    if (kind == PictureOf::still)
      drawn.compositor.draw_still(drawn.cache, seen, *stage.visibility, drawn.frame);
    else drawn.compositor.draw(drawn.cache, seen, *stage.visibility, drawn.frame);
    EXPECT_EQ(drawn.frame.width, seen.width);
    expect_light(drawn.frame);
  };
  for (int i = 0; i < 8; i++) step(view, PictureOf::moving, pixels / 8);
  float points = drawn.cache.stats().points;
  for (int i = 0; i < 8; i++) step(around, PictureOf::moving, 1);
  EXPECT_GE(drawn.cache.stats().points, 0.99f * points);  // none was lost
  for (int i = 0; i < 64; i++) step(around, PictureOf::moving, pixels / 8);
  EXPECT_LE(drawn.cache.stats().points, 1.1f * float(pixels));
  for (int i = 0; i < 4; i++) step(around, PictureOf::still, pixels / 8);
  for (int i = 0; i < 4; i++) step(view, PictureOf::still, pixels / 8);
  EXPECT_GE(drawn.cache.stats().points, 0.5f * float(pixels));
}

// A visitor who has just arrived sees shapes at once, also at rest.
TEST(Drawn, StillPicturesHaveExactShapesWithFewPoints) {
  Stage stage(make_room());
  DrawnVisit drawn;
  View view = view_from(stage, 0, width, height);
  for (int i = 0; i < 8; i++) drawn.step(stage, view, pixels / 200, PictureOf::still);
  EXPECT_LT(count_wrong_at_rest(stage, view, drawn.frame), pixels / 1000);
  Frame truth = stage.truth(view, 32);
  EXPECT_LT(rmse(drawn.frame, truth), 0.065);
  expect_light(drawn.frame);
}

// Points of before that are seen through gaps of nearer ones lend no pixel their shape or their
// light.
TEST(Drawn, WhoStopsSeesNoPointThroughGaps) {
  Stage stage(make_room());
  DrawnVisit drawn;
  View view;
  for (int i = 0; i < 28; i++) {
    view = view_from(stage, 0.01 * std::min(i, 20), width, height);
    bool stands = i >= 21;
    drawn.step(stage, view, stands ? pixels / 400 : pixels / 40,
               stands ? PictureOf::still : PictureOf::moving);
  }
  EXPECT_LT(count_wrong_at_rest(stage, view, drawn.frame), pixels / 1000);
  Frame truth = stage.truth(view, 32);
  EXPECT_LT(rmse(drawn.frame, truth), 0.105);
}

// Who stops is shown what was known before, and nothing is allocated anew but the mean of pictures
// at rest.
TEST(Drawn, StartingAndStoppingLosesNoPoint) {
  Stage stage = make_room_with_ball();
  DrawnVisit visit;
  auto view = [&](double x) { return view_from(stage, x, width, height); };
  for (int i = 0; i < 24; i++) visit.step(stage, view(0), pixels / 8, PictureOf::still);
  CacheStats rested = visit.cache.stats();
  ASSERT_GT(rested.reprojected, 0.8f);
  size_t at_rest = visit.memory_bytes();
  visit.step(stage, view(0.01), pixels / 60, PictureOf::moving);
  size_t moving = visit.memory_bytes();
  for (int i = 2; i < 6; i++) visit.step(stage, view(0.01 * i), pixels / 60, PictureOf::moving);
  EXPECT_NEAR(double(visit.memory_bytes()), double(moving), 1 << 15);  // the memory is 1.3 MB
  visit.step(stage, view(0), 0, PictureOf::still);
  EXPECT_GT(visit.cache.stats().reprojected, 0.98f * rested.reprojected);
  EXPECT_LT(visit.memory_bytes(), at_rest - 5 * pixels);  // memory for the samples comes later
  for (int i = 0; i < 2; i++) visit.step(stage, view(0), pixels / 8, PictureOf::still);
  EXPECT_NEAR(double(visit.memory_bytes()), double(at_rest), 1 << 15);
  EXPECT_NEAR(double(at_rest - moving), 12.0 * pixels,
              1 << 15);  // means over pictures and over samples
}

// Lamps and the sky are as they are without a single sample.
TEST(Drawn, EmitsWithoutASample) {
  Stage stage(make_emitting());
  View view = make_view(stage.scene, {0, 0, 0}, 0, 0, 1, 101, 67);
  for (PictureOf kind : {PictureOf::moving, PictureOf::still})
    for (int budget : {0, 12}) {
      DrawnVisit visit;
      for (int i = 0; i < 3; i++) visit.step(stage, view, budget, kind);
      auto color = [&](int x, int y) { return visit.frame.color[size_t(y * 101 + x)]; };
      // The mean at rest is kept in half the precision.
      float rounding = kind == PictureOf::still ? 2e-3f : 1e-5f;
      EXPECT_LT(glm::length(color(50, 33) - vec3(3, 2, 1)), rounding);
      EXPECT_LT(glm::length(color(4, 4) - vec3(0.5f, 1, 2)), rounding);
      EXPECT_LT(glm::length(color(100, 66) - vec3(0.5f, 1, 2)), rounding);
    }
}

// Nothing known at all: the frame has the shapes and no light but the lamp's, and nothing breaks.
TEST(Drawn, AnEmptyCacheIsDark) {
  Stage stage(make_room());
  View view = view_from(stage, 0, 64, 48);
  for (PictureOf kind : {PictureOf::moving, PictureOf::still}) {
    DrawnVisit visit;
    visit.step(stage, view, 0, kind);
    EXPECT_EQ(visit.requests.size(), 0u);
    EXPECT_LE(count_wrong_at_rest(stage, view, visit.frame), 64 * 48 / 1000);
    int lit = 0;
    for (vec3 c : visit.frame.color) {
      ASSERT_TRUE(is_finite(c));
      lit += c != vec3(0);
    }
    EXPECT_LT(lit, 64 * 48 / 8);
  }
}

}  // namespace
}  // namespace wellspring::test
