// SPDX-License-Identifier: Apache-2.0
// Where the next samples go.
#include "cache/plan.h"

#include <gtest/gtest.h>

#include <set>

#include "cache/attention.h"
#include "cache/packing.h"
#include "unit/cache/room.h"

namespace wellspring::test {
namespace {

struct Planner {
  PointCache points;
  PointImage image;
  View view = look_at(vec3(0), vec3(0, 0, -1), 60, 160, 90);
  std::vector<Request> requests;
  Planner() {
    resize_points(points, 160 * 90);
    resize_image(image, 160, 90);
  }
  void plan(int budget, uint64_t seed, bool still = false) {
    plan_requests(points, view, {budget, seed, still}, image, requests);
  }
};

TEST(Plan, ExactBudgetAndNoPixelTwice) {
  for (int budget : {0, 1, 7, 288, 5000, 14400, 1000000}) {
    Planner p;
    std::fill(p.image.priority.begin(), p.image.priority.end(), uint8_t(90));
    p.plan(budget, 5);
    EXPECT_EQ(int(p.requests.size()), std::min(budget, 14400));
    std::set<uint32_t> pixels;
    for (const Request& r : p.requests) EXPECT_TRUE(pixels.insert(r.pixel).second);
  }
}

TEST(Plan, NothingToLearnNothingAsked) {
  Planner p;
  p.plan(100, 1);
  EXPECT_TRUE(p.requests.empty());
  p.image.priority[33] = 1;
  p.plan(100, 1);
  ASSERT_EQ(p.requests.size(), 1u);
  EXPECT_EQ(p.requests[0].pixel, 33u);
}

TEST(Plan, DenserWherePriorityIsHigher) {
  double left = 0, right = 0;
  for (uint64_t seed = 0; seed < 20; seed++) {
    Planner p;
    for (size_t i = 0; i < p.image.priority.size(); i++)
      p.image.priority[i] = i % 160 < 80 ? 200 : 50;
    p.plan(720, seed);
    for (const Request& r : p.requests) (r.pixel % 160 < 80 ? left : right) += 1;
  }
  EXPECT_NEAR(left / right, 4, 0.4);
}

TEST(Plan, SpreadsEvenlyWithoutClumps) {
  // Every 16x10 patch of an even picture gets its share within a factor, in every frame.
  for (uint64_t seed = 1; seed < 6; seed++) {
    Planner p;
    std::fill(p.image.priority.begin(), p.image.priority.end(), uint8_t(120));
    p.plan(1440, seed);
    std::vector<int> patch(90, 0);
    for (const Request& r : p.requests)
      patch[size_t(r.pixel / 160 / 10 * 10 + r.pixel % 160 / 16)]++;
    for (int n : patch) {
      EXPECT_GE(n, 8);
      EXPECT_LE(n, 24);
    }
  }
}

TEST(Plan, EveryPixelIsReachedInTime) {
  Planner p;
  std::vector<int> waits(14400, 0);
  std::set<uint32_t> seen;
  for (uint64_t frame = 0; frame < 400; frame++) {
    for (size_t i = 0; i < waits.size(); i++)
      p.image.priority[i] = uint8_t(std::min(1 + waits[i]++ * 2, 255));
    p.plan(288, frame);
    for (const Request& r : p.requests) seen.insert(r.pixel), waits[r.pixel] = 0;
  }
  EXPECT_EQ(seen.size(), 14400u);
}

TEST(Plan, RaysPassThroughTheirPixelOrExactlyThroughTheOldPoint) {
  Planner p;
  vec3 d = view_ray(p.view, 30.2f, 40.7f).direction;
  vec3 place = d * 7.0f;
  p.points.x[9] = place.x, p.points.y[9] = place.y, p.points.z[9] = place.z;
  p.points.flags[9] = point_used;
  p.image.point[40 * 160 + 30] = 9;
  std::fill(p.image.priority.begin(), p.image.priority.end(), uint8_t(100));
  p.plan(14400, 3);
  int resamples = 0;
  for (const Request& r : p.requests) {
    Projected at = project_point(p.view, r.ray.origin + r.ray.direction * 5.0f);
    EXPECT_NEAR(at.x, float(r.pixel % 160) + 0.5f, 0.501f);
    EXPECT_NEAR(at.y, float(r.pixel / 160) + 0.5f, 0.501f);
    if (r.resample == no_cache_id) continue;
    resamples++;
    EXPECT_EQ(r.resample, 9u);
    EXPECT_GT(dot(r.ray.direction, d), 1 - 1e-6f);
  }
  EXPECT_EQ(resamples, 1);
}

TEST(Plan, SameSeedSamePlan) {
  Planner a, b;
  for (auto* p : {&a, &b}) {
    for (size_t i = 0; i < p->image.priority.size(); i++)
      p->image.priority[i] = uint8_t(i * 7 % 251);
    p->plan(500, 77);
  }
  ASSERT_EQ(a.requests.size(), b.requests.size());
  for (size_t i = 0; i < a.requests.size(); i++) {
    EXPECT_EQ(a.requests[i].pixel, b.requests[i].pixel);
    EXPECT_EQ(a.requests[i].seed, b.requests[i].seed);
    EXPECT_EQ(a.requests[i].ray.direction, b.requests[i].ray.direction);
  }
}

TEST(Attention, EmptyBeforeOldBeforeFresh) {
  Planner p;
  auto put = [&](int x, int y, uint32_t i, uint8_t age, uint8_t count) {
    p.image.point[size_t(y * 160 + x)] = i;
    p.image.depth[size_t(y * 160 + x)] = 2;
    p.points.age[i] = age;
    p.points.count[i] = count;
    p.points.flags[i] = point_used;
  };
  put(10, 10, 1, 0, 20);
  put(30, 10, 2, 250, 20);
  put(50, 10, 3, 0, 1);
  prioritise(p.points, {}, p.image);
  auto at = [&](int x, int y) { return int(p.image.priority[size_t(y * 160 + x)]); };
  EXPECT_EQ(at(100, 50), 255);
  EXPECT_LT(at(11, 10), 255);
  EXPECT_GT(at(11, 10), at(30, 10));
  EXPECT_GT(at(30, 10), at(50, 10));
  EXPECT_GT(at(50, 10), at(10, 10));
  EXPECT_GT(at(10, 10), 0);
  CacheSettings even{.attention = false};
  prioritise(p.points, even, p.image);
  EXPECT_EQ(at(10, 10), at(100, 50));
}

struct Changes : testing::Test {
  Planner p;
  Rng rng{11};
  void SetUp() override {
    for (uint32_t i = 0; i < 14400; i++) {
      vec3 place = view_ray(p.view, float(i % 160) + 0.5f, float(i / 160) + 0.5f).direction * 3.0f;
      p.image.point[i] = i, p.points.age[i] = 10, p.points.count[i] = 30;
      p.points.flags[i] = point_used;
      p.points.x[i] = place.x, p.points.y[i] = place.y, p.points.z[i] = place.z;
    }
  }
  static uint32_t at(int x, int y) { return uint32_t(y * 160 + x); }
  // `count` change samples around (x, y), each from `say`.
  template <class Say>
  void hear(int x, int y, int count, const Say& say) {
    for (int i = 0; i < count; i++) {
      ChangeSample change_sample = say();
      change_sample.point = at(x + i % 8, y + i / 8 % 8);
      p.image.change_samples.push_back(change_sample);
    }
  }
  void hear(int x, int y, int count, float change, float noise = 0) {
    hear(x, y, count, [&] { return ChangeSample{0, change, noise}; });
  }
  void judge() { age_changed(p.points, p.view, p.image); }
};

TEST_F(Changes, AgeTheNeighbourhoodOnce) {
  hear(44, 44, 9, -0.8f);
  judge();
  EXPECT_EQ(p.points.age[at(44, 44)], 10);  // they may err
  hear(44, 44, 60, -0.8f);
  judge();
  EXPECT_EQ(p.points.age[at(44, 44)], 42);
  EXPECT_LE(p.points.count[at(44, 44)], 2);
  EXPECT_TRUE(p.image.renewed[at(44, 44)]);  // and pictures are told
  EXPECT_FALSE(p.image.renewed[at(140, 80)]);
  EXPECT_EQ(p.points.age[at(28, 44)], 42);
  EXPECT_EQ(p.points.age[at(100, 44)], 10);
  judge();
  EXPECT_EQ(p.points.age[at(44, 44)], 42);
}

// Each for itself might be chance; together they are not, though no frame has many.
TEST_F(Changes, FewWitnessesAFrameAddUp) {
  for (int frame = 1; frame <= 7; frame++) {
    hear(44, 44, 4, 0.5f);
    judge();
    EXPECT_EQ(p.points.age[at(44, 44)], frame < 7 ? 10 : 42) << frame;
  }
}

TEST_F(Changes, NoiseIsNoChange) {
  // Half of the tiles hear samples of a skewed distribution: one in twenty is thirty times as
  // bright as the rest, which are darker than the mean.
  for (int frame = 0; frame < 400; frame++) {
    hear(32, 32, 20, [&] {
      bool bright = rng.uniform() < 0.05f;
      return ChangeSample{0, bright ? 0.92f : -0.6f, 2.6f};
    });
    // The others hear of points that have few samples yet, and know no noise.
    hear(96, 32, 20, [&] { return ChangeSample{0, rng.uniform() < 0.5f ? -0.7f : 0.7f, 0}; });
    judge();
  }
  EXPECT_EQ(p.points.age[at(36, 36)], 10);
  EXPECT_EQ(p.points.age[at(100, 36)], 10);
}

// A small change at one place is not believed as long as nothing else has changed; after a change
// elsewhere less will do.
TEST_F(Changes, WhereOneThingHasChangedLessWillDo) {
  auto small = [&] { hear(108, 44, 60, -0.1f, 0.15f); };
  small();
  judge();
  EXPECT_EQ(p.points.age[at(108, 44)], 10);
  hear(28, 44, 60, -0.8f);
  judge();
  ASSERT_EQ(p.points.age[at(28, 44)], 42);
  EXPECT_EQ(p.points.age[at(108, 44)], 10);
  small();
  judge();
  EXPECT_EQ(p.points.age[at(108, 44)], 42);
  // Not for long.
  for (int i = 0; i < 60; i++) judge();
  hear(76, 76, 60, -0.1f, 0.15f);
  judge();
  EXPECT_EQ(p.points.age[at(76, 76)], 10);
}

// Noisy samples show a change only over many tiles, and then each tile is judged more finely.
TEST_F(Changes, AreFoundTogetherWhereNoTileTellsAlone) {
  auto everywhere = [&](float change) {
    for (int y = 4; y < 80; y += 16)
      for (int x = 4; x < 150; x += 16)
        hear(x, y, 12, [&] {
          return ChangeSample{0, change + (rng.uniform() < 0.5f ? -1.5f : 1.5f), 1.5f};
        });
  };
  auto forgotten = [&] {
    int count = 0;
    for (uint8_t flags : p.points.flags) count += bool(flags & point_relit);
    return count;
  };
  for (int i = 0; i < 12; i++) everywhere(0), judge();
  EXPECT_EQ(forgotten(), 0);
  for (int i = 0; i < 12; i++) everywhere(-0.4f), judge();
  EXPECT_GT(forgotten(), 10000);
}

// The farther one of two points in a pixel may show in the next picture.
TEST_F(Changes, HiddenPointsForgetToo) {
  uint32_t behind = at(150, 80), aside = at(151, 80);
  auto put = [&](uint32_t i, int x, int y, float depth) {
    vec3 place = view_ray(p.view, float(x) + 0.4f, float(y) + 0.4f).direction * depth;
    p.points.x[i] = place.x, p.points.y[i] = place.y, p.points.z[i] = place.z;
  };
  for (uint8_t& flags : p.points.flags) flags |= point_visible;
  for (uint32_t i : {behind, aside}) p.points.flags[i] = point_used;
  put(behind, 44, 44, 3.2f), put(aside, 100, 20, 3.2f);
  hear(44, 44, 60, -0.8f);
  judge();
  EXPECT_TRUE(p.points.flags[behind] & point_relit);
  EXPECT_EQ(p.points.age[behind], 42);
  EXPECT_FALSE(p.points.flags[aside] & point_relit);
}

TEST_F(Changes, WhatWasSampledJustNowStays) {
  p.points.age[at(45, 44)] = 0, p.points.count[at(45, 44)] = 1;
  hear(44, 44, 60, -0.8f);
  judge();
  EXPECT_TRUE(p.points.flags[at(44, 44)] & point_relit);
  EXPECT_FALSE(p.points.flags[at(45, 44)] & point_relit);
}

TEST_F(Changes, SmallOnesAreLeftToTheMeans) {
  hear(44, 44, 60, 0.05f);
  judge();
  EXPECT_EQ(p.points.age[at(44, 44)], 10);
}

// A moving view has carried points elsewhere since; the points around their present place age.
TEST_F(Changes, AreSeenWhereTheViewHasCarriedThem) {
  View turned = look_at(vec3(0), view_ray(p.view, 120, 45).direction, 60, 160, 90);
  hear(116, 41, 40, 0.9f);  // the points of column 120 are in the middle now
  hear(2, 2, 40, 0.9f);     // these points are out of view
  age_changed(p.points, turned, p.image);
  EXPECT_EQ(p.points.age[at(80, 45)], 42);
  EXPECT_EQ(p.points.age[at(4, 4)], 10);
  EXPECT_TRUE(p.image.change_samples.empty());
}

}  // namespace
}  // namespace wellspring::test
