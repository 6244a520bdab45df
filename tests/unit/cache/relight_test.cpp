// SPDX-License-Identifier: Apache-2.0
// Lamps are switched, and the cache is told.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "cache/packing.h"
#include "cache/point_cache.h"
#include "unit/cache/visit.h"
#include "unit/picture/drawn_visit.h"

namespace wellspring::test {
namespace {

View hall() { return look_at(vec3(-1, 1.6f, 4), vec3(-0.2f, 0.9f, -2), 60, 160, 90); }

constexpr int pixels = 160 * 90;

// Says that all light changes, and nothing more.
bool everywhere(const RenderCache::Surface&, vec3&, vec3&) { return true; }

// Holds the pixels that look different in the other light, and counts how many of them are within
// 10 % of right.
struct Affected {
  Frame before, after;
  int count = 0;
  Affected(const Room& was, const Room& is, int spp)
      : before(render_room(was, hall(), spp)), after(render_room(is, hall(), spp, 7)) {
    for (size_t i = 0; i < after.color.size(); i++) count += is_affected(i);
  }
  bool is_affected(size_t i) const {
    float was = luminance(before.color[i]), is = luminance(after.color[i]);
    return std::abs(was - is) > 0.1f * std::max(was, is) + 1e-4f;
  }
  float share_right(const Frame& frame) const {
    int right = 0;
    for (size_t i = 0; i < after.color.size(); i++) {
      float wanted = luminance(after.color[i]), shown = luminance(frame.color[i]);
      right += is_affected(i) && std::abs(shown - wanted) <= 0.1f * wanted + 1e-4f;
    }
    return float(right) / float(std::max(count, 1));
  }
};

// A spot light is switched in a room that the lamp in its ceiling lights too; then half a second at
// 60 pictures a second and one sample for `mismatch` pixels.
struct Switched {
  float before = 0;          // share right of the same pixels, long at rest in the old light
  std::vector<float> right;  // each picture's share
};
Switched switch_spot(bool told, bool on, int mismatch) {
  Visit v;
  v.room.noisy = false;
  v.room.spot = !on;
  Room other = v.room;
  other.spot = on;
  Affected affected(v.room, other, 64);
  EXPECT_GT(affected.count, pixels / 8);
  for (int i = 0; i < 160; i++) v.step(hall(), pixels / 6);
  Switched result;
  result.before = Affected(other, v.room, 64).share_right(v.frame);
  v.room = other;
  if (told) v.cache.relight(everywhere);
  for (int i = 0; i < 30; i++) {
    v.step(hall(), pixels / mismatch);
    result.right.push_back(affected.share_right(v.frame));
  }
  return result;
}

// Not all can be right: stripes finer than a pixel take more samples than these. So what counts is
// how many are after a long rest: nine tenths as many if the cache is told, half if it finds out.
TEST(Relight, HalfASecondMakesUpNineTenthsIfToldAndHalfIfFound) {
  for (bool on : {true, false}) {
    Switched told = switch_spot(true, on, 16);
    EXPECT_GT(told.before, 0.85f);
    EXPECT_GE(told.right.back(), 0.9f * told.before) << (on ? "on" : "off");
    EXPECT_GT(told.right[4], 0.6f) << (on ? "on" : "off");
    // Untold it is found out by samples (cache/attention.h), a few pictures later.
    Switched found = switch_spot(false, on, 16);
    EXPECT_GT(told.right[1], found.right[1] + 0.1f) << (on ? "on" : "off");
    EXPECT_GE(found.right.back(), 0.5f * found.before) << (on ? "on" : "off");
  }
}

// A box whose lamp stays while a spot light, and a shadow with it, comes and goes; of light that
// falls directly, whose converged picture is soon to be had. Shapes are drawn, as visitors see
// them.
Scene make_box(bool spot) {
  Scene scene = scenes::make_cornell_box();
  for (Material& material : scene.materials) material.emission = vec3(0);
  PunctualLight lamp{.position = {0.02f, 0.45f, 0.05f}, .intensity = {0.15f, 0.15f, 0.17f}};
  scene.lights.push_back(lamp);
  lamp.type = PunctualType::spot;
  lamp.position = {-0.2f, 0.5f, 0.1f};
  lamp.direction = normalize(vec3(0.45f, -0.75f, -0.6f));
  lamp.inner_cone = 0.5f, lamp.outer_cone = 0.7f;
  lamp.intensity = {0.7f, 0.65f, 0.5f};
  if (spot) scene.lights.push_back(lamp);
  return scene;
}
struct Box : Stage {
  TransportSettings transport;
  explicit Box(bool spot) : Stage(make_box(spot)) { transport.max_depth = 2; }
  View view() const { return make_view(scene, {0, 0.25, 0.6}, 0, 0, 0.75f, 160, 120); }
  Frame truth() const { return Stage::truth(view(), 256, transport); }
};

// Share of the affected pixels within 10 % of right after `pictures` in the new light.
float right_in_drawn_pictures(const Box& was, const Box& is, const std::vector<vec3>& before,
                              const std::vector<vec3>& after, PictureOf shown, bool told,
                              int mismatch, int pictures) {
  DrawnVisit visit;
  for (int i = -60; i < pictures; i++) {
    const Box& box = i < 0 ? was : is;
    View view = box.view();
    if (shown == PictureOf::moving && (pictures - i) % 2 == 0)
      view.position.x += 0.004f;  // the last is seen from the place
    if (i == 0 && told) visit.cache.relight(everywhere);
    visit.transport = box.transport;
    visit.sample(box, view, view.width * view.height / mismatch);
    visit.cache.remember(view, visit.requests, visit.samples);
    visit.compositor.follow_changes(visit.cache);
    visit.compositor.add_samples(view, visit.requests, visit.samples);
    if (shown == PictureOf::moving)
      visit.compositor.draw(visit.cache, view, *box.visibility, visit.frame);
    else visit.compositor.draw_still(visit.cache, view, *box.visibility, visit.frame);
  }
  int affected = 0, right = 0;
  for (size_t i = 0; i < after.size(); i++) {
    float old = luminance(before[i]), wanted = luminance(after[i]),
          light = luminance(visit.frame.color[i]);
    if (std::abs(old - wanted) <= 0.1f * std::max(old, wanted) + 1e-4f) continue;
    affected++;
    right += std::abs(light - wanted) <= 0.1f * wanted + 1e-4f;
  }
  EXPECT_GT(affected, 160 * 120 / 6);
  return float(right) / float(std::max(affected, 1));
}

// Nine in ten of those that a switch changes, at one sample for 16 pixels.
TEST(Relight, DrawnPicturesAreRightInHalfASecond) {
  Box dark(false), lit(true);
  std::vector<vec3> without = dark.truth().color, with = lit.truth().color;
  for (PictureOf shown : {PictureOf::still, PictureOf::moving})
    for (bool told : {true, false}) {
      float least = shown == PictureOf::still ? 0.9f : 0.85f;
      EXPECT_GE(right_in_drawn_pictures(dark, lit, without, with, shown, told, 16, 30), least)
          << told;
      EXPECT_GE(right_in_drawn_pictures(lit, dark, with, without, shown, told, 16, 30), least)
          << told;
    }
}

TEST(Relight, OnlyPointsOfWhichItIsSaidForget) {
  PointCache points;
  resize_points(points, 16);
  for (uint32_t i = 0; i < 16; i++) {
    points.flags[i] = point_used | point_visible;
    points.age[i] = 3, points.count[i] = 20;
    points.color[i].smooth = pack_rgb9e5(vec3(4, 2, 1));
    points.color[i].rest = pack_rgb9e5(vec3(2));
  }
  points.age[2] = evicted_age;
  invalidate_light(points, [](uint32_t i, vec3& kept, vec3& added) {
    if (i == 3) kept = vec3(0.5f, 1, 0), added = vec3(0, 1, 8);
    return i <= 4;
  });
  for (uint32_t i = 0; i < 16; i++) {
    bool lit = i <= 4 && i != 2;
    EXPECT_EQ(points.age[i], lit ? 254 : i == 2 ? evicted_age : 3) << i;
    EXPECT_EQ(points.count[i], lit ? 0 : 20) << i;
    EXPECT_EQ(bool(points.flags[i] & point_relit), lit) << i;
    vec3 smooth = i == 3 ? vec3(2, 3, 8) : vec3(4, 2, 1), rest = i == 3 ? vec3(1, 2, 0) : vec3(2);
    EXPECT_EQ(unpack_rgb9e5(points.color[i].smooth), smooth) << i;
    EXPECT_EQ(unpack_rgb9e5(points.color[i].rest), rest) << i;
  }
}

// The sky is no surface that a lamp lights.
TEST(Relight, AsksForNothingAtInfinity) {
  Visit v;
  View view = look_at(vec3(0), vec3(0, 0, -1), 60, 32, 18);
  v.cache.resize(view.width, view.height);
  v.cache.project(view);
  v.cache.attend();
  v.cache.plan(view, view.width * view.height, 1, v.requests);
  v.samples.assign(v.requests.size(), Sample{});
  for (size_t i = 0; i < v.requests.size(); i++) {
    const Ray& ray = v.requests[i].ray;
    Sample& sample = v.samples[i];
    sample.position = ray.direction, sample.distance = INFINITY, sample.rest = vec3(1);
    if (i % 2 == 0) continue;
    sample.position = ray.origin + 5.0f * ray.direction, sample.distance = 5;
    sample.normal = -ray.direction, sample.albedo = vec3(0.5f);
    sample.object = 1, sample.flags = sample_hit;
  }
  v.cache.remember(view, v.requests, v.samples);
  std::atomic<int> surfaces = 0, others = 0;
  v.cache.relight([&](const RenderCache::Surface& at, vec3&, vec3&) {
    const vec3 place = at.place;
    (length(place) > 4 ? surfaces : others)++;
    return true;
  });
  EXPECT_GT(surfaces, 100);
  EXPECT_EQ(others, 0);
}

TEST(Relight, SwitchedAgainAndAgainStaysFinite) {
  Visit v;
  for (int i = 0; i < 40; i++) {
    v.room.spot = i % 3 != 0;
    v.cache.relight([&](const RenderCache::Surface& at, vec3& kept, vec3& added) {
      const vec3 place = at.place;
      if (i % 4 == 0) kept = vec3(v.room.spot ? 1.0f : 0.5f), added = vec3(v.room.spot);
      return i % 2 == 0 || length(place - vec3(2.5f, 2.8f, 2.0f)) < 3;
    });
    v.step(hall(), i % 5 == 0 ? 0 : 500);
    for (vec3 c : v.frame.color) ASSERT_TRUE(is_finite(c) && c.x >= 0 && c.y >= 0 && c.z >= 0);
  }
  v.cache.relight([](const RenderCache::Surface&, vec3& kept, vec3& added) {
    kept = vec3(-1, 0, NAN), added = vec3(NAN, -1, 0);
    return true;
  });
  v.step(hall(), 100);
  for (vec3 c : v.frame.color) ASSERT_TRUE(is_finite(c) && c.x >= 0 && c.y >= 0 && c.z >= 0);
}

}  // namespace
}  // namespace wellspring::test
