// SPDX-License-Identifier: Apache-2.0
// With few points the light is a guess, but shapes and reflectances are exact.
#include "cache/overlay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cache/cache.h"
#include "cache/compose_drawn.h"
#include "frame/tonemap.h"
#include "frame/compare.h"
#include "light/technique.h"
#include "scenes/scenes.h"

using namespace wellspring;
using namespace wellspring::scenes;

namespace {

struct Visit {
  RenderCache cache;
  std::vector<Request> requests;
  std::vector<Sample> samples;
  Frame frame;
  uint64_t tick = 1;

  void step(const World& world, const Lights& lights, const View& view, int budget,
            const PictureSight* sight) {
    cache.resize(view.width, view.height);
    cache.move_points(world);
    cache.project(view);
    cache.attend();
    cache.plan(view, budget, tick++, requests);
    samples.resize(requests.size());
    trace(*find_technique("path"), world, lights, {}, requests, samples);
    cache.remember(view, requests, samples);
    cache.reconstruct(view, frame, sight);
  }
  // As step(), drawn in light of half the resolution.
  void draw(const World& world, const Lights& lights, const View& view, int budget,
            const PictureSight& sight) {
    View light = light_view(view);
    cache.resize(view.width, view.height);
    cache.move_points(world);
    cache.project(light);
    cache.attend();
    cache.plan(light, budget, tick++, requests);
    samples.resize(requests.size());
    trace(*find_technique("path"), world, lights, {}, requests, samples);
    cache.remember(light, requests, samples);
    cache.draw(view, sight, frame);
  }
};

// A box with a picture on its back wall, thin bars before it, and a moving ball.
struct Room {
  Scene scene;
  Mesh ball;
  Room() {
    scene = make_cornell_box();
    Image image;
    image.width = image.height = 32;
    for (int i = 0; i < 32 * 32; i++)
      for (uint8_t c : {(i / 2 + i / 64) % 2 ? 220 : 30, 120, 60, 255}) image.texels8.push_back(c);
    scene.images.push_back(image);
    Texture texture;
    texture.image = int(scene.images.size()) - 1;
    scene.textures.push_back(texture);
    Material picture = diffuse(vec3(1));
    picture.base_color_texture.texture = int(scene.textures.size()) - 1;
    add_quad(scene, add_material(scene, picture), {-0.2f, 0.2f, -0.54f}, {0.4f, 0, 0}, {0, 0.3f, 0},
             "picture");
    int dark = add_material(scene, diffuse(vec3(0.1f)));
    for (int i = 0; i < 6; i++)
      add_quad(scene, dark, {-0.25f + 0.1f * float(i), 0, -0.1f}, {0.004f, 0, 0}, {0, 0.5f, 0},
               "bar");
    ball = sphere_mesh(add_material(scene, diffuse(vec3(0.7f, 0.6f, 0.1f))), 0.08f, 16);
    for (vec3& p : ball.positions) p += vec3(0, 0.1f, 0);
    scene.objects.push_back("ball");
  }
};

// Pixels that show another object than a ray through their centre meets.
int count_wrong(const World& world, const View& view, const Frame& frame) {
  int wrong = 0;
  for (int y = 0; y < view.height; y++)
    for (int x = 0; x < view.width; x++) {
      Hit hit = world.intersect(view_ray(view, float(x) + 0.5f, float(y) + 0.5f));
      uint32_t object = hit.valid() ? world.object_of(hit.instance) : 0;
      wrong += frame.object[size_t(y * view.width + x)] != object;
    }
  return wrong;
}

// What is drawn for the eye at once is the frame, tone-mapped; along edges colours are mixed before
// the curve or behind it.
void expect_same_for_the_eye(Visit& drawn, const View& view, const PictureSight& sight) {
  for (float exposure : {1.0f, 3.5f}) {
    Image8 expected, shown, alone;
    std::vector<float> depth;
    tonemap(drawn.frame, {exposure}, expected);
    drawn.cache.draw(view, sight, Tonemap{exposure}, shown, &depth);
    drawn.cache.draw(view, sight, Tonemap{exposure}, alone);
    EXPECT_EQ(shown.width, view.width);
    EXPECT_EQ(shown.height, view.height);
    EXPECT_EQ(depth, drawn.frame.depth);
    EXPECT_EQ(alone.rgb, shown.rgb);
    ASSERT_EQ(shown.rgb.size(), expected.rgb.size());
    std::vector<bool> mixed(depth.size(), false);
    for (const auto& list : sight.see_edges(view, vec2(0.5f), [](const SightRun&) {}))
      for (const EdgeShare& edge : list) mixed[edge.pixel] = true;
    EXPECT_LT(std::count(mixed.begin(), mixed.end(), true), ptrdiff_t(mixed.size() / 8));
    for (size_t i = 0; i < shown.rgb.size(); i++)
      if (!mixed[i / 3]) {
        ASSERT_NEAR(shown.rgb[i], expected.rgb[i], 1) << "byte " << i << ", exposure " << exposure;
      }
  }
}

}  // namespace

TEST(Overlay, ShowsExactShapesWithFewPoints) {
  Room room;
  World world(room.scene, {room.ball}, {uint32_t(room.scene.objects.size() - 1)});
  world.commit();
  Lights lights = make_lights(world);
  PictureSight sight(world, lights);
  Visit drawn, guessed;
  constexpr int width = 160, height = 120, pixels = width * height;
  View view;
  for (int i = 0; i < 24; i++) {
    if (i == 12) {  // teleported: nothing is known of most of it
      for (vec3& p : room.ball.positions) p.x += 0.1f;
      world.move(0, room.ball.positions, room.ball.normals);
      world.commit();
    }
    double x = 0.002 * i + (i >= 12 ? 0.1 : 0);
    view = make_view(room.scene, {x, 0.25, 0.6}, 0, 0, 0.7f, width, height);
    drawn.step(world, lights, view, pixels / 40, &sight);
    guessed.step(world, lights, view, pixels / 40, nullptr);
  }
  EXPECT_LT(count_wrong(world, view, drawn.frame), pixels / 2000);
  EXPECT_GT(count_wrong(world, view, guessed.frame), pixels / 100);  // so the case is hard
  StillSettings settings;
  settings.spp = 32;
  Frame truth = render_still(*find_technique("path"), world, lights, view, settings);
  EXPECT_LT(rmse(drawn.frame, truth), 0.8 * rmse(guessed.frame, truth));
  for (vec3 c : drawn.frame.color) ASSERT_TRUE(is_finite(c) && c.x >= 0 && c.y >= 0 && c.z >= 0);
}

TEST(Overlay, ShinesWithoutASample) {
  Scene scene = empty_scene();
  scene.environment.radiance = vec3(0.5f, 1, 2);
  add_quad(scene, add_material(scene, emitter(vec3(3, 2, 1))), {-1, -1, -4}, {2, 0, 0}, {0, 2, 0},
           "lamp");
  World world(scene);
  world.commit();
  Lights lights = make_lights(world);
  PictureSight sight(world, lights);
  Visit visit;
  View view = make_view(scene, {0, 0, 0}, 0, 0, 1, 96, 64);
  for (int i = 0; i < 3; i++) visit.step(world, lights, view, 12, &sight);
  auto color = [&](int x, int y) { return visit.frame.color[size_t(y * 96 + x)]; };
  EXPECT_LT(glm::length(color(48, 32) - vec3(3, 2, 1)), 0.05f);
  EXPECT_LT(glm::length(color(4, 4) - vec3(0.5f, 1, 2)), 0.05f);
}

// Nothing known at all: the frame has the shapes and no light, and nothing breaks.
TEST(Overlay, AnEmptyCacheIsDark) {
  Room room;
  World world(room.scene);
  world.commit();
  Lights lights = make_lights(world);
  PictureSight sight(world, lights);
  Visit visit;
  View view = make_view(room.scene, {0, 0.25, 0.6}, 0, 0, 0.7f, 64, 48);
  visit.step(world, lights, view, 0, &sight);
  EXPECT_EQ(visit.requests.size(), 0u);
  for (vec3 c : visit.frame.color) ASSERT_TRUE(is_finite(c));
}

// Who has just arrived sees shapes at once, also at rest.
TEST(Overlay, RestsWithExactShapesAndFewPoints) {
  Room room;
  World world(room.scene);
  world.commit();
  Lights lights = make_lights(world);
  PictureSight sight(world, lights);
  Visit drawn, guessed;
  constexpr int width = 160, height = 120, pixels = width * height;
  View view = make_view(room.scene, {0, 0.25, 0.6}, 0, 0, 0.7f, width, height);
  for (int i = 0; i < 8; i++) {
    drawn.step(world, lights, view, pixels / 200, &sight);
    guessed.step(world, lights, view, pixels / 200, nullptr);
  }
  EXPECT_LT(count_wrong(world, view, drawn.frame), pixels / 500);
  EXPECT_GT(count_wrong(world, view, guessed.frame), pixels / 50);
}

// Points of before that are seen through gaps of nearer ones do not stay at rest; those of the very view do.
TEST(Overlay, WhoStopsSeesNoPointThroughGaps) {
  Room room;
  World world(room.scene);
  world.commit();
  Lights lights = make_lights(world);
  PictureSight sight(world, lights);
  Visit visit;
  constexpr int width = 160, height = 120, pixels = width * height;
  View view;
  for (int i = 0; i < 28; i++) {
    view = make_view(room.scene, {0.01 * std::min(i, 20), 0.25, 0.6}, 0, 0, 0.7f, width, height);
    visit.step(world, lights, view, i < 20 ? pixels / 40 : pixels / 400, &sight);
  }
  EXPECT_LT(count_wrong(world, view, visit.frame), pixels / 1000);
}

// Odd sizes and both kinds of size in turn: tiles, blocks and light pixels end anywhere.
TEST(Overlay, LightOfHalfTheResolutionIsEnough) {
  Room room;
  World world(room.scene, {room.ball}, {uint32_t(room.scene.objects.size() - 1)});
  world.commit();
  Lights lights = make_lights(world);
  PictureSight sight(world, lights);
  for (ivec2 size : {ivec2(160, 120), ivec2(151, 97)}) {
    Visit drawn, overlaid, guessed;
    int pixels = size.x * size.y;
    View view;
    for (int i = 0; i < 24; i++) {
      for (vec3& p : room.ball.positions) p.x += 0.004f;
      world.move(0, room.ball.positions, room.ball.normals);
      world.commit();
      double x = 0.002 * i + (i >= 12 ? 0.1 : 0);
      view = make_view(room.scene, {x, 0.25, 0.6}, 0, 0, 0.7f, size.x, size.y);
      drawn.draw(world, lights, view, pixels / 60, sight);
      overlaid.step(world, lights, view, pixels / 60, &sight);
      guessed.step(world, lights, view, pixels / 60, nullptr);
    }
    ASSERT_EQ(drawn.frame.color.size(), size_t(pixels));
    expect_same_for_the_eye(drawn, view, sight);
    EXPECT_LT(count_wrong(world, view, drawn.frame), pixels / 1000);
    for (size_t i = 0; i < drawn.frame.object.size(); i++)
      ASSERT_EQ(drawn.frame.object[i] == 0, std::isinf(drawn.frame.depth[i])) << i;
    StillSettings settings;
    settings.spp = 32;
    Frame truth = render_still(*find_technique("path"), world, lights, view, settings);
    double error = rmse(drawn.frame, truth);
    EXPECT_LT(error, 1.1 * rmse(overlaid.frame, truth)) << size.x;
    EXPECT_LT(error, 0.9 * rmse(guessed.frame, truth)) << size.x;
    for (vec3 c : drawn.frame.color)
      ASSERT_TRUE(is_finite(c) && c.x >= 0 && c.y >= 0 && c.z >= 0);
  }
}

// Who stops is shown what was known before, and nothing is allocated anew.
TEST(Overlay, StartingAndStoppingLosesNoPoint) {
  Room room;
  World world(room.scene, {room.ball}, {uint32_t(room.scene.objects.size() - 1)});
  world.commit();
  Lights lights = make_lights(world);
  PictureSight sight(world, lights);
  constexpr int width = 160, height = 120, pixels = width * height;
  Visit visit;
  auto view = [&](double x) {
    return make_view(room.scene, {x, 0.25, 0.6}, 0, 0, 0.7f, width, height);
  };
  for (int i = 0; i < 24; i++) visit.step(world, lights, view(0), pixels / 8, &sight);
  CacheStats rested = visit.cache.stats();
  ASSERT_GT(rested.reprojected, 0.8f);
  visit.draw(world, lights, view(0.01), pixels / 60, sight);
  size_t memory = visit.cache.memory_bytes();
  for (int i = 2; i < 6; i++) visit.draw(world, lights, view(0.01 * i), pixels / 60, sight);
  visit.step(world, lights, view(0), 0, &sight);
  EXPECT_GT(visit.cache.stats().reprojected, 0.98f * rested.reprojected);
  EXPECT_NEAR(double(visit.cache.memory_bytes()), double(memory), 1 << 15);  // of 1.3 MB
}

TEST(Overlay, DrawnPicturesShineAndMayBeDark) {
  Scene scene = empty_scene();
  scene.environment.radiance = vec3(0.5f, 1, 2);
  add_quad(scene, add_material(scene, emitter(vec3(3, 2, 1))), {-1, -1, -4}, {2, 0, 0}, {0, 2, 0},
           "lamp");
  World world(scene);
  world.commit();
  Lights lights = make_lights(world);
  PictureSight sight(world, lights);
  for (int budget : {0, 12}) {
    Visit visit;
    View view = make_view(scene, {0, 0, 0}, 0, 0, 1, 101, 67);
    for (int i = 0; i < 3; i++) visit.draw(world, lights, view, budget, sight);
    auto color = [&](int x, int y) { return visit.frame.color[size_t(y * 101 + x)]; };
    EXPECT_LT(glm::length(color(50, 33) - vec3(3, 2, 1)), 1e-5f);
    EXPECT_LT(glm::length(color(4, 4) - vec3(0.5f, 1, 2)), 1e-5f);
    EXPECT_LT(glm::length(color(100, 66) - vec3(0.5f, 1, 2)), 1e-5f);
  }
}
