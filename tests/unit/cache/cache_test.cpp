// SPDX-License-Identifier: Apache-2.0
// The whole cache as a visitor meets it.
#include "cache/cache.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <limits>

#include "cache/packing.h"
#include "cache/point_cache.h"
#include "judge/compare.h"
#include "unit/cache/visit.h"

namespace wellspring::test {
namespace {

struct Visitor : Visit {
  testing::AssertionResult finite() const {
    for (size_t i = 0; i < frame.color.size(); i++) {
      vec3 c = frame.color[i];
      if (!is_finite(c) || c.x < 0 || c.y < 0 || c.z < 0 || !(frame.depth[i] > 0) ||
          !std::isfinite(frame.confidence[i]))
        return testing::AssertionFailure()
               << "pixel " << i << ": " << c.x << " " << c.y << " " << c.z << " depth "
               << frame.depth[i] << " confidence " << frame.confidence[i];
    }
    return testing::AssertionSuccess();
  }
  // Says whether this pixel shows the lamp alone, whose own light needs no sample; along its edges
  // other pixels have a share of it.
  bool shows_lamp_alone() const {
    for (int i = 0; i < int(frame.color.size()); i++)
      if (frame.color[size_t(i)] != vec3(0) && !touches(i, 7)) return false;
    return true;
  }
  // The pixel or one of its neighbours shows the object.
  bool touches(int pixel, uint32_t object) const {
    int x = pixel % frame.width, y = pixel / frame.width;
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, frame.height - 1); v++)
      for (int u = std::max(x - 1, 0); u <= std::min(x + 1, frame.width - 1); u++)
        if (frame.object[size_t(v * frame.width + u)] == object) return true;
    return false;
  }
  size_t memory_bytes() const { return cache.memory_bytes() + compositor.memory_bytes(); }
};

View hall(int width = 160, int height = 90) {
  return look_at(vec3(-1, 1.6f, 4), vec3(-0.2f, 0.9f, -2), 60, width, height);
}

float wrong_objects(const Frame& frame, const Frame& truth) {
  int wrong = 0;
  for (size_t i = 0; i < frame.object.size(); i++) wrong += frame.object[i] != truth.object[i];
  return float(wrong) / float(frame.object.size());
}

TEST(Cache, TheFirstFrameShowsSomethingEverywhere) {
  Visitor v;
  v.step(hall(), 160 * 90 / 50);
  int black = 0;
  for (size_t i = 0; i < v.frame.color.size(); i++) black += luminance(v.frame.color[i]) <= 0;
  EXPECT_LT(black, 160 * 90 / 50);
  EXPECT_EQ(v.cache.stats().empty, 0);
  EXPECT_NEAR(v.cache.stats().fresh, 0.02, 0.001);
}

TEST(Cache, StandingStillConvergesToTheReference) {
  Visitor v;
  v.room.noisy = false;
  Frame truth = render_room(v.room, hall(), 256);
  double before = 0;
  for (int i = 0; i < 700; i++) {
    v.step(hall(), 160 * 90 / 20);
    if (i == 20) before = rmse(v.frame, truth);
  }
  double after = rmse(v.frame, truth);
  EXPECT_LT(after, before * 0.35);
  EXPECT_LT(relative_mse(v.frame, truth), 0.004);
  EXPECT_GT(v.cache.stats().converged, 0.5);
}

TEST(Cache, NoisyLightConvergesToo) {
  Visitor v;
  View view = hall(64, 36);
  Frame truth = render_room(v.room, view, 1500);
  for (int i = 0; i < 40; i++) v.step(view, 120);
  double early = relative_mse(v.frame, truth);
  for (int i = 0; i < 600; i++) v.step(view, 120);
  double late = relative_mse(v.frame, truth);
  EXPECT_LT(late, early * 0.7);
  // The bound is the error of as many samples without a cache, averaged: 33 a pixel.
  EXPECT_LT(late, relative_mse(render_room(v.room, view, 33, 3), truth));
}

TEST(Cache, WalkingShowsTheRightSurfaces) {
  Visitor v;
  View view;
  for (int i = 0; i < 90; i++) {
    float s = float(i) / 30;
    view = look_at(vec3(-2 + 0.8f * s, 1.6f, 4 - 0.9f * s), vec3(-0.5f, 0.9f, -2), 60, 160, 90);
    v.step(view, 160 * 90 / 32);
  }
  EXPECT_LT(wrong_objects(v.frame, render_room(v.room, view, 1)), 0.05);
  EXPECT_GT(v.cache.stats().reprojected, 0.4);
}

TEST(Cache, ColoursNeverLeakAcrossObjects) {
  // Red and blue walls, nothing red or blue elsewhere: whatever object a pixel shows, its hue is
  // that one's, but along edges, which are antialiased.
  Visitor v;
  v.room.noisy = false;
  View view = hall();
  for (int i = 0; i < 12; i++) v.step(view, 400);
  int checked = 0;
  for (size_t i = 0; i < v.frame.color.size(); i++) {
    vec3 c = v.frame.color[i];
    float ratio = c.x / std::max(c.z, 1e-6f);
    bool inside = true;
    for (int dy : {-1, 0, 1})
      for (int dx : {-1, 0, 1}) {
        int x = std::clamp(int(i) % view.width + dx, 0, view.width - 1),
            y = std::clamp(int(i) / view.width + dy, 0, view.height - 1);
        inside &= v.frame.object[size_t(y * view.width + x)] == v.frame.object[i];
      }
    auto expect = [&](uint32_t object, float value, float wanted, float error) {
      if (!inside || v.frame.object[i] != object) return;
      EXPECT_NEAR(value, wanted, error) << "pixel " << i << " object " << object;
      checked++;
    };
    expect(3, ratio, 0.7f / 0.2f, 0.3f);
    expect(4, ratio, 0.25f / 0.7f, 0.05f);
    expect(9, c.y / c.x, 3.5f, 0.3f);
  }
  EXPECT_GT(checked, 2000);
}

TEST(Cache, TeleportLeavesNothingOfTheOldView) {
  Visitor v;
  for (int i = 0; i < 60; i++) v.step(hall(), 400);
  View other =
      look_at(vec3(2, 1.5f, -3), vec3(3.9f, 1.4f, -3), 60, 160, 90);  // close before the blue wall
  v.step(other, 400);
  v.step(other, 400);
  EXPECT_LT(wrong_objects(v.frame, render_room(v.room, other, 1)), 0.12);
  for (int i = 0; i < 100; i++) v.step(other, 400);
  EXPECT_LT(wrong_objects(v.frame, render_room(v.room, other, 1)), 0.02);
}

// Points of what was seen before the view began later are not shown before it.
TEST(Cache, WhatIsCutAwayIsNotShownFromMemory) {
  Visitor v;
  for (int i = 0; i < 60; i++) v.step(hall(), 400);
  View cut = hall();
  cut.near = 4;
  for (int i = 0; i < 60; i++) v.step(cut, 400);
  const Scene scene = make_room_scene(v.room);
  const World world(scene);
  int wrong = 0, gone = 0;
  for (int y = 0; y < cut.height; y++)
    for (int x = 0; x < cut.width; x++) {
      auto object_at = [&](const View& view) {
        const Hit hit = world.intersect(view_ray(view, float(x) + 0.5f, float(y) + 0.5f));
        return hit.valid() ? world.object_of(hit.instance) : 0u;
      };
      gone += object_at(hall()) != object_at(cut);
      wrong += v.frame.object[size_t(y * cut.width + x)] != object_at(cut);
    }
  EXPECT_GT(gone, 700);
  EXPECT_LT(wrong, 400);
}

TEST(Cache, SpinningAndOddFieldsOfViewStaySound) {
  Visitor v;
  for (float fov : {5.0f, 60.0f, 150.0f})
    for (int i = 0; i < 18; i++) {
      float angle = float(i) / 9 * 2 * pi;
      vec3 eye(0.1f, 1.5f, 2);
      v.step(look_at(eye, eye + vec3(std::sin(angle), 0.1f, std::cos(angle)), fov, 96, 54), 100);
      ASSERT_TRUE(v.finite()) << fov;
      EXPECT_EQ(v.cache.stats().empty, 0);
    }
}

TEST(Cache, ResizeDuringMotionKeepsThePoints) {
  Visitor v;
  for (int i = 0; i < 40; i++) v.step(hall(160, 90), 700);
  v.step(hall(120, 68), 10);
  EXPECT_EQ(v.frame.width, 120);
  EXPECT_GT(v.cache.stats().reprojected, 0.5);
  v.step(hall(200, 112), 10);
  EXPECT_GT(v.cache.stats().reprojected, 0.2);
  v.step(hall(1, 1), 1);
  EXPECT_EQ(v.frame.color.size(), 1u);
  v.step(hall(3, 300), 50);
  EXPECT_TRUE(v.finite());
}

TEST(Cache, ABlackSceneIsBlackAndNoSamplesAreNoLight) {
  Visitor v;
  v.room.lamp = v.room.spot = false;
  for (int i = 0; i < 5; i++) v.step(hall(), 300);
  for (vec3 c : v.frame.color) ASSERT_EQ(c, vec3(0));
  EXPECT_TRUE(v.finite());
  Visitor empty;
  empty.step(hall(), 0);
  EXPECT_EQ(empty.cache.stats().empty, 1);
  EXPECT_TRUE(empty.finite());
  EXPECT_TRUE(empty.shows_lamp_alone());
}

TEST(Cache, SamplesThatAreNotNumbersDoNoHarm) {
  Visitor v;
  v.step(hall(), 300);
  v.cache.project(hall());
  v.cache.attend();
  v.cache.plan(hall(), 300, 9, v.requests);
  trace_room(v.room, v.requests, v.samples);
  float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  for (size_t i = 0; i < v.samples.size(); i++) {
    if (i % 3 == 0) v.samples[i].smooth = vec3(nan);
    if (i % 5 == 0) v.samples[i].position = vec3(inf, nan, 0);
    if (i % 7 == 0) v.samples[i].normal = vec3(0);
    if (i % 11 == 0) v.samples[i].rest = vec3(-5, 1e38f, 0);
    if (i % 13 == 0) v.samples[i].albedo = vec3(-1, 7, nan);
  }
  v.cache.remember(hall(), v.requests, v.samples);
  v.show(hall());
  EXPECT_TRUE(v.finite());
}

TEST(Cache, ClearForgets) {
  Visitor v;
  for (int i = 0; i < 10; i++) v.step(hall(), 300);
  v.cache.clear();
  v.cache.project(hall());
  v.show(hall());
  EXPECT_EQ(v.cache.stats().points, 0);
  EXPECT_TRUE(v.shows_lamp_alone());
}

TEST(Cache, LightSwitchedOffIsSeenWithoutBeingTold) {
  Visitor v;
  v.room.lamp = false;
  v.room.bounces = 0;  // only the sharp light of the spot
  for (int i = 0; i < 60; i++) v.step(hall(), 700);
  v.room.spot = false;
  for (int i = 0; i < 60; i++) v.step(hall(), 700);
  double sum = 0;
  for (vec3 c : v.frame.color) sum += luminance(c);
  EXPECT_LT(sum / double(v.frame.color.size()), 0.003);
}

TEST(Cache, MemoryIsBoundedAndToldHonestly) {
  Visitor v;
  v.cache = RenderCache({}, make_cache_work());  // as visitors share what only drawing takes
  v.compositor = Compositor(std::make_shared<CompositorWork>());
  View view = hall(1280, 720);
  for (int i = 0; i < 3; i++) v.step(view, 20000);  // from the third on it is at rest
  EXPECT_LE(v.memory_bytes(), size_t(64) << 20);
  EXPECT_GE(v.memory_bytes(), size_t(1280 * 720) * 50);
  size_t before = v.memory_bytes();
  v.step(view, 20000);
  EXPECT_LE(v.memory_bytes(), before + (1 << 16));
}

TEST(Cache, TheSameBitsWhateverTheThreads) {
  auto visit = [] {
    Visitor v;
    for (int i = 0; i < 12; i++)
      v.step(look_at(vec3(-1 + 0.05f * float(i / 2), 1.6f, 4), vec3(0, 0.9f, -2), 60, 200, 120),
             600);
    return v.frame;
  };
  Frame many = visit();
  oneapi::tbb::global_control single(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  Frame one = visit();
  EXPECT_EQ(many.color, one.color);
  EXPECT_EQ(many.depth, one.depth);
  EXPECT_EQ(many.object, one.object);
}

TEST(Cache, ALongVisitNeitherDriftsNorGrows) {
  Visitor v;
  v.room.noisy = false;
  View rest = hall(48, 27);
  size_t memory = 0;
  double first = 0;
  for (int i = 0; i < 6000; i++) {
    bool walking = i / 200 % 2;
    float s = walking ? float(i % 200) / 30 : 0;
    View view =
        look_at(vec3(-1 + std::sin(s), 1.6f, 4 - s * 0.2f), vec3(-0.2f, 0.9f, -2), 60, 48, 27);
    v.step(walking ? view : rest, 60);
    if (i % 500 == 0) {
      ASSERT_TRUE(v.finite());
    }
    if (i == 599)
      first = rmse(v.frame, render_room(v.room, v.room.noisy ? view : rest, 4)),
      memory = v.memory_bytes();
  }
  for (int i = 0; i < 200; i++) v.step(rest, 60);
  EXPECT_LE(v.memory_bytes(), memory + 4096);
  EXPECT_LT(rmse(v.frame, render_room(v.room, rest, 64)), std::max(first, 0.3));
}

TEST(Cache, MovingPointsFollowTheirTriangle) {
  Mesh mesh{.positions = {vec3(-1, -1, -3), vec3(1, -1, -3), vec3(0, 1, -3)},
            .normals = {vec3(0, 0, 1), vec3(0, 0, 1), vec3(0, 0, 1)},
            .triangles = {uvec3(0, 1, 2)}};
  Scene scene;
  scene.materials.resize(1);
  scene.objects = {"", "figure"};
  World world(scene, {mesh}, {1});
  PointCache points;
  resize_points(points, 64);
  points.flags[3] = point_used | point_moving | point_visible;
  points.age[3] = 0;
  points.normal[3] = pack_normal(vec3(0, 0, 1));
  points.anchors.push_back({3, 0, 0, 0, 65535});  // replaced by the newer one
  points.anchors.push_back({3, 0, 0, 65535 / 2, 65535 / 4});
  points.anchors.push_back({4, 0, 0, 0, 0});           // its point lives no more
  points.anchors.push_back({3 + 64 * 0, 7, 0, 0, 0});  // its instance does not exist
  std::vector<vec3> moved = mesh.positions, normals = mesh.normals;
  for (vec3& p : moved) p += vec3(5, 2, -1);
  world.move(0, moved, normals);
  world.commit();
  move_anchored_points(points, world);
  ASSERT_EQ(points.anchors.size(), 1u);
  vec3 expected = 0.25f * moved[0] + 0.5f * moved[1] + 0.25f * moved[2];
  EXPECT_NEAR(points.x[3], expected.x, 1e-3);
  EXPECT_NEAR(points.y[3], expected.y, 1e-3);
  EXPECT_NEAR(points.z[3], expected.z, 1e-3);
}

}  // namespace
}  // namespace wellspring::test
