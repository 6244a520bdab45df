// SPDX-License-Identifier: Apache-2.0
// What a mirror shows is found again from elsewhere.
#include <gtest/gtest.h>

#include <cmath>

#include "cache/cache.h"
#include "unit/cache/room.h"

namespace wellspring {
namespace {

constexpr int width = 160, height = 90, pixels = width * height;

// A mirror in the plane z = -2 that shows a wall of stripes 3 m behind the visitor's line, z = 3 m
// before the mirror: its image lies at z = -5.
vec3 stripes(const Ray& ray) {
  float x = ray.origin.x + ray.direction.x * ((-5 - ray.origin.z) / ray.direction.z);
  return int(std::floor(x * 4)) & 1 ? vec3(0.8f) : vec3(0.1f);
}
Sample look(const Request& request, bool tells) {
  const Ray& ray = request.ray;
  Sample s;
  s.distance = (-2 - ray.origin.z) / ray.direction.z;
  s.position = ray.origin + ray.direction * s.distance;
  s.normal = vec3(0, 0, 1);
  s.object = 1;
  s.flags = sample_hit | sample_specular;
  s.rest = stripes(ray);
  if (tells) s.image = (-5 - ray.origin.z) / ray.direction.z;
  return s;
}

struct Stroll {
  RenderCache cache;
  Frame frame;
  std::vector<Request> requests;
  std::vector<Sample> samples;
  explicit Stroll(const CacheSettings& settings = {.images = true}) : cache(settings) {}
  void step(const View& view, uint64_t tick, bool tells, int budget = pixels / 32) {
    cache.project(view);
    cache.attend();
    cache.plan(view, budget, tick, requests);
    samples.clear();
    for (const Request& request : requests) samples.push_back(look(request, tells));
    cache.remember(view, requests, samples);
    cache.reconstruct(view, frame);
  }
};

View beside(float x) { return look_at(vec3(x, 0, 0), vec3(x, 0, -1), 60, width, height); }

// Share of pixels that are nearer to the other stripe's colour; those cut by an edge do not count.
float wrong_share(const Frame& frame, const View& view) {
  int wrong = 0, counted = 0;
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++) {
      vec3 left = stripes(view_ray(view, float(x), float(y) + 0.5f)),
           right = stripes(view_ray(view, float(x) + 1, float(y) + 0.5f));
      if (left != right) continue;
      counted++;
      wrong += std::abs(frame.color[size_t(y * width + x)].x - left.x) > 0.35f;
    }
  return float(wrong) / float(counted);
}

float walk_past(bool images, bool tells) {
  CacheSettings settings;
  settings.images = images;
  Stroll stroll(settings);
  View view;
  for (int i = 0; i < 90; i++) {
    view = beside(0.015f * float(i));
    stroll.step(view, uint64_t(i + 1), tells);
  }
  return wrong_share(stroll.frame, view);
}

TEST(Mirror, ShowsItsImageFromWhereverTheVisitorStands) {
  float at_image = walk_past(true, true), on_surface = walk_past(false, true);
  EXPECT_LT(at_image, 0.03f);
  EXPECT_LT(at_image, 0.25f * on_surface);
}

TEST(Mirror, WithoutAnImageIsKeptOnItsSurface) {
  EXPECT_EQ(walk_past(true, false), walk_past(false, true));
}

TEST(Mirror, AtRestConverges) {
  Stroll stroll;
  View view = beside(0);
  for (int i = 0; i < 200; i++) stroll.step(view, uint64_t(i + 1), true, pixels / 4);
  EXPECT_LT(wrong_share(stroll.frame, view), 0.002f);
  EXPECT_GT(stroll.cache.stats().converged,
            0.5f);  // beside a point in the mirror is still the mirror
}

TEST(Mirror, PlacesThatAreNoneDoNoHarm) {
  Stroll stroll;
  View view = beside(0);
  for (float image : {-1.0f, 1e30f, INFINITY, NAN}) {
    stroll.cache.project(view);
    stroll.cache.attend();
    stroll.cache.plan(view, pixels / 32, 7, stroll.requests);
    stroll.samples.clear();
    for (const Request& request : stroll.requests) {
      stroll.samples.push_back(look(request, false));
      stroll.samples.back().image = image;
    }
    stroll.cache.remember(view, stroll.requests, stroll.samples);
    stroll.cache.reconstruct(view, stroll.frame);
    for (vec3 c : stroll.frame.color) ASSERT_TRUE(is_finite(c)) << image;
  }
}

}  // namespace
}  // namespace wellspring
