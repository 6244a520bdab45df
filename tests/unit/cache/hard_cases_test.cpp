// SPDX-License-Identifier: Apache-2.0
// What visitors do that is hard for a cache, and scenes that are.
#include <gtest/gtest.h>

#include <cmath>

#include "unit/cache/visit.h"

namespace wellspring {
namespace {

constexpr int width = 160, height = 90, pixels = width * height;

View at(vec3 eye, vec3 target) { return look_at(eye, target, 60, width, height); }

// Shares of the picture whose object is neither that of the pixel's centre nor of a corner.
float wrong_share(const Visit& v, const View& view) {
  int wrong = 0;
  for (int y = 0; y < view.height; y++)
    for (int x = 0; x < view.width; x++) {
      uint32_t shown = v.frame.object[size_t(y * view.width + x)];
      bool right = false;
      for (vec2 at : {vec2(0.5f), vec2(0), vec2(1, 0), vec2(0, 1), vec2(1)}) {
        Request request;
        request.ray = view_ray(view, float(x) + at.x, float(y) + at.y);
        right |= trace_room(v.room, request).object == shown;
      }
      wrong += !right;
    }
  return float(wrong) / float(view.width * view.height);
}

bool is_sound(const Visit& v) {
  for (size_t i = 0; i < v.frame.color.size(); i++)
    if (!is_finite(v.frame.color[i]) || !(v.frame.depth[i] > 0)) return false;
  return true;
}

TEST(HardCases, ThroughAWallAndOutBehindIt) {
  // The wall of the big ball: towards it, into it, through, and out at its back.
  Visit v;
  View view;
  for (int i = 0; i <= 150; i++) {
    view = at(vec3(1.3f, 0.8f, 1.5f - 0.04f * float(i)), vec3(1.3f, 0.8f, -20));
    v.step(view, pixels / 16);
    ASSERT_TRUE(is_sound(v)) << i;
    if (i == 100) {  // inside, 0.1 m behind its middle
      EXPECT_LT(wrong_share(v, view), 0.02f);
    }
  }
  EXPECT_LT(wrong_share(v, view), 0.02f);  // 0.3 m before the far wall
}

TEST(HardCases, AFullTurnInThreeTenthsOfASecond) {
  Visit v;
  auto turned = [](float share) {
    float a = share * 2 * pi;
    return at(vec3(0.1f, 1.5f, 2), vec3(0.1f + std::sin(a), 1.45f, 2 - std::cos(a)));
  };
  for (int i = 0; i < 40; i++) v.step(turned(0), pixels / 16);
  for (int i = 1; i <= 18; i++) {
    v.step(turned(float(i) / 18), pixels / 16);
    ASSERT_TRUE(is_sound(v)) << i;
    EXPECT_EQ(v.cache.stats().empty, 0) << i;
  }
  // What was seen before the turn is not all forgotten; a quarter of a second later nothing is
  // amiss.
  EXPECT_GT(v.cache.stats().reprojected, 0.1);
  for (int i = 0; i < 15; i++) v.step(turned(0), pixels / 16);
  EXPECT_LT(wrong_share(v, turned(0)), 0.02f);
}

TEST(HardCases, FarFromTheOriginSurfacesAreAsRight) {
  // Positions are relative to the scene's origin; what is left are coordinates of some hundred
  // metres.
  auto visit = [](vec3 shift) {
    Visit v;
    v.room.noisy = false;
    View here;
    for (int i = 0; i < 30; i++) {
      here = at(vec3(-1 + 0.02f * float(i), 1.6f, 4), vec3(-0.2f, 0.9f, -2));
      View view = here;
      view.position += shift;
      v.cache.resize(width, height);
      v.cache.project(view);
      v.cache.attend();
      v.cache.plan(view, pixels / 8, uint64_t(i + 1), v.requests);
      for (Request& r : v.requests) r.ray.origin -= shift;
      trace_room(v.room, v.requests, v.samples);
      for (Sample& s : v.samples) s.position += shift;
      v.cache.remember(view, v.requests, v.samples);
      v.cache.reconstruct(view, v.frame);
    }
    return wrong_share(v, here);
  };
  float near = visit(vec3(0)), far = visit(vec3(256, 0, -512));
  EXPECT_LT(near, 0.02f);
  EXPECT_NEAR(far, near, 0.002f);
}

// Upright bars, a pixel and a half wide, before a wall.
TEST(HardCases, ThinRailingsNeitherVanishNorSmear) {
  auto object_at = [](const Ray& ray, vec3& place) {
    place = ray.origin + ray.direction * ((-3 - ray.origin.z) / ray.direction.z);
    float across = place.x / 0.25f;
    if (std::abs(across - std::round(across)) < 0.12f) return 1u;
    place = ray.origin + ray.direction * ((-6 - ray.origin.z) / ray.direction.z);
    return 2u;
  };
  RenderCache cache;
  Frame frame;
  std::vector<Request> requests;
  std::vector<Sample> samples;
  int bars = 0, missing = 0, wrong = 0, counted = 0;
  for (int i = 0; i < 120; i++) {
    View view = at(vec3(0.01f * float(i), 1, 0), vec3(0.01f * float(i), 1, -1));
    cache.resize(width, height);
    cache.project(view);
    cache.attend();
    cache.plan(view, pixels / 8, uint64_t(i + 1), requests);
    samples.assign(requests.size(), Sample{});
    for (size_t k = 0; k < requests.size(); k++) {
      Sample& s = samples[k];
      s.object = object_at(requests[k].ray, s.position);
      s.normal = vec3(0, 0, 1);
      s.albedo = vec3(0.5f);
      s.smooth = vec3(s.object == 1 ? 0.2f : 1.0f);
      s.flags = sample_hit;
    }
    cache.remember(view, requests, samples);
    cache.reconstruct(view, frame);
    if (i < 60) continue;
    for (int y = 20; y < 70; y++)
      for (int x = 0; x < width; x++) {
        vec3 place;
        uint32_t shown = frame.object[size_t(y * width + x)];
        uint32_t left = object_at(view_ray(view, float(x), float(y) + 0.5f), place),
                 right = object_at(view_ray(view, float(x) + 1, float(y) + 0.5f), place),
                 middle = object_at(view_ray(view, float(x) + 0.5f, float(y) + 0.5f), place);
        counted++;
        bars += middle == 1;
        missing += middle == 1 && shown != 1;
        wrong += shown != left && shown != right && shown != middle;
      }
  }
  EXPECT_LT(double(missing) / bars, 0.2);
  EXPECT_LT(double(wrong) / counted, 0.05);
}

// The yellow ball is dragged across the view. Told of it, the cache carries its points along.
TEST(HardCases, AnObjectDraggedAcrossTheViewTakesItsPointsAlong) {
  auto drag = [](bool told, int rest) {
    Visit v;
    v.room.noisy = false;
    View view = at(vec3(-1, 1.6f, 4), vec3(-0.2f, 0.9f, -2));
    for (int i = 0; i < 60; i++) v.step(view, pixels / 8);
    mat4 moved(1);
    moved[3] = vec4(0.04f, 0, 0.02f, 1);
    for (int i = 0; i < 40; i++) {
      v.room.ball_offset += vec3(moved[3]);
      if (told) v.cache.move_object(8, moved);
      v.step(view, pixels / 16);
    }
    for (int i = 0; i < rest; i++) v.step(view, pixels / 16);
    return wrong_share(v, view);
  };
  float told = drag(true, 0), untold = drag(false, 0);
  EXPECT_LT(told, 0.012f);
  EXPECT_LT(told, 0.5f * untold);
  EXPECT_LT(drag(false, 60), 0.01f);  // a ghost does not stay for ever either
}

TEST(HardCases, MovesThatAreNoneMoveNothing) {
  Visit v;
  View view = at(vec3(-1, 1.6f, 4), vec3(-0.2f, 0.9f, -2));
  for (int i = 0; i < 20; i++) v.step(view, pixels / 8);
  mat4 broken(1);
  broken[3].x = NAN;
  v.cache.move_object(8, broken);
  v.cache.move_object(999, mat4(2));
  v.step(view, 0);
  EXPECT_LT(wrong_share(v, view), 0.02f);
}

}  // namespace
}  // namespace wellspring
