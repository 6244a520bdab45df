// SPDX-License-Identifier: Apache-2.0
// Which pixels samples cover, from the view they were traced for and from others.
#include "benchmark/corrective/warp_and_splat.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/rng.h"
#include "unit/benchmark/corrective/stage.h"

namespace wellspring::test {
namespace {

using test::Picture;
using test::Stage;

// A store that has seen all of a view.
SampleStore traced(const Stage& stage, const View& view, int levels = 4) {
  SampleStore store{.grid = make_sqrt5_grid(levels)};
  add_samples(store, view, 0, stage.trace_all(view, store.grid));
  return store;
}

// One sample of object 1 in the middle of a picture that shows nothing else.
struct OneSample {
  SampleStore store;
  View view = view_of_balls(101, 101);
  std::vector<uint32_t> object = std::vector<uint32_t>(101 * 101, 1);
  void add(int level, float z, float color, uint32_t age = 0) {
    CorrectiveSample sample{1, level, vec3(0, 0, z), vec3(0, 0, 1), number_words(color)};
    ASSERT_EQ(add_samples(store, view, age, {&sample, 1}), 1);
  }
  Picture from(float z) {
    View now = view;
    now.position.z = z;
    return splat(store, now, object);
  }
};

bool same(const Picture& a, const Picture& b) {
  return a.level == b.level && a.color.size() == b.color.size() &&
         std::memcmp(a.color.data(), b.color.data(), a.color.size() * sizeof(SampleWords)) == 0;
}

TEST(WarpAndSplat, AllLevelsOfOneViewAreTheTracedPictureBitForBit) {
  Stage stage = two_balls();
  for (int levels : {1, 2, 3, 4, 5, 8})
    for (float angle : {0.0f, 0.4f, 2.0f}) {
      View view = view_of_balls(150, 121, angle);
      Picture picture = splat(traced(stage, view, levels), view, stage.objects(view));
      EXPECT_EQ(count_wrong(picture, stage, view), 0) << levels << " levels, " << angle;
      EXPECT_EQ(picture.stats.samples, picture.stats.splats);
      EXPECT_EQ(picture.stats.pixels, picture.stats.samples);
    }
}

TEST(WarpAndSplat, TheSizeOfTheWorldDoesNotMatter) {
  for (float unit : {1e-3f, 1.0f, 1e6f}) {
    Stage stage = two_balls(unit);
    View view = view_of_balls(150, 121, 0.3f, 4, unit);
    SampleStore store = traced(stage, view);
    EXPECT_EQ(count_wrong(splat(store, view, stage.objects(view)), stage, view), 0) << unit;
    View nearer = view_of_balls(150, 121, 0.5f, 3, unit);
    EXPECT_GT(splat(store, nearer, stage.objects(nearer)).stats.pixels, 4000) << unit;
  }
}

// Positions are relative to the scene's origin, however far that is from zero.
TEST(WarpAndSplat, AThousandKilometresFromZeroNothingChanges) {
  Stage stage = two_balls();
  Scene near, far;
  far.origin = dvec3(1e6, -1e6, 3e5);
  auto view_of = [](const Scene& scene) {
    return make_view(scene, scene.origin + dvec3(0.7, 0.3, 4), 0.2f, -0.05f, 1, 150, 121);
  };
  ASSERT_EQ(view_of(near), view_of(far));
  View view = view_of(far);
  EXPECT_EQ(count_wrong(splat(traced(stage, view), view, stage.objects(view)), stage, view), 0);
  // The origin is far from the balls, so that floats are too coarse; nothing worse happens.
  for (test::Ball& ball : stage.balls) ball.center += vec3(1e6f);
  view.position += vec3(1e6f);
  SplatStats stats = splat(traced(stage, view), view, stage.objects(view)).stats;
  EXPECT_LE(stats.splats, stats.samples);
}

TEST(WarpAndSplat, SamplesTouchOnlyPixelsOfTheirOwnObject) {
  Stage stage = two_balls();
  View view = view_of_balls(150, 121), now = view_of_balls(150, 121, 0.2f, 3.6f);
  SampleStore store;
  std::vector<CorrectiveSample> samples = stage.trace_all(view, store.grid);
  for (CorrectiveSample& sample : samples) sample.words = number_words(float(sample.object));
  add_samples(store, view, 0, samples);
  std::vector<uint32_t> object = stage.objects(now);
  Picture picture = splat(store, now, object);
  int shown = 0, seen = 0;
  for (size_t i = 0; i < object.size(); i++) {
    float expected = picture.level[i] ? float(object[i]) : -1.0f;
    ASSERT_EQ(picture.color[i], number_words(float(expected)));
    shown += picture.level[i] != 0;
    seen += object[i] != 0;
  }
  EXPECT_EQ(picture.stats.pixels, shown);
  EXPECT_GT(shown, seen * 8 / 10);  // most of what is seen was seen before
}

TEST(WarpAndSplat, FinerLevelsCoverCoarserAndNearerSamplesThoseBehind) {
  OneSample one;
  one.add(2, 0.5f, 2);
  one.add(1, 0.9f, 1);  // nearer, but coarse
  Picture picture = one.from(4);
  size_t middle = 50 * 101 + 50;
  EXPECT_EQ(picture.color[middle], number_words(2));
  EXPECT_EQ(picture.level[middle], 2);
  EXPECT_EQ(picture.level[middle + 5], 1);
  one.add(2, 0.7f, 3);
  one.add(2, 0.1f, 4);
  EXPECT_EQ(one.from(4).color[middle], number_words(3));
  one.add(2, 0.7f, 5, 1);  // as near, and newer
  EXPECT_EQ(one.from(4).color[middle], number_words(5));
  one.add(4, 0.2f, 6);  // a single pixel
  one.add(4, 0.2f, 7, 1);
  one.add(4, 0.1f, 8, 1);
  EXPECT_EQ(one.from(4).color[middle], number_words(7));
}

TEST(WarpAndSplat, FootprintsGrowAsTheEyeComesNearerUpToFourTimes) {
  const float distances[] = {4, 2, 1.3333f, 1, 0.5f, 8, 100};
  const int sides[] = {4, 8, 12, 16, 16, 2, 1};
  for (size_t i = 0; i < std::size(sides); i++) {
    OneSample one;
    one.add(2, 0, 1);
    Picture picture = one.from(distances[i]);
    EXPECT_EQ(picture.stats.pixels, sides[i] * sides[i]) << distances[i];
    size_t first = size_t(test::footprint_begin(50, sides[i]));
    EXPECT_EQ(picture.level[first * 101 + first], 2);
    EXPECT_EQ(picture.level[(first - 1) * 101 + first], 0);
  }
}

TEST(WarpAndSplat, FootprintsReachIntoThePictureFromOutside) {
  OneSample one;
  one.add(1, 0, 1);  // 11 pixels wide
  View aside = one.view;
  // A pixel is 4 / 101 m wide at 4 m: the middle goes 53 pixels to the left, 3 beyond the border.
  aside.position.x += 53 * 4.0f / 101;
  Picture picture = splat(one.store, aside, one.object);
  EXPECT_EQ(picture.stats.pixels, 3 * 11);
  EXPECT_EQ(picture.level[50 * 101 + 2], 1);
  EXPECT_EQ(picture.level[50 * 101 + 3], 0);
  aside.position.x += 100;
  EXPECT_EQ(splat(one.store, aside, one.object).stats.splats, 0);
  View turned = one.view;  // the sample is behind
  turned.forward = vec3(0, 0, 1), turned.right = vec3(-1, 0, 0);
  EXPECT_EQ(splat(one.store, turned, one.object).stats.splats, 0);
}

TEST(WarpAndSplat, ASurfaceThatShowsItsOtherSideIsLeftOut) {
  OneSample one;
  one.add(2, 0, 1);
  View behind = view_of_balls(101, 101, pi);
  EXPECT_EQ(splat(one.store, behind, one.object).stats.splats, 0);
  // A sample traced from behind is shown from there.
  CorrectiveSample sample{1, 2, vec3(0), vec3(0, 0, 1), {}};
  add_samples(one.store, behind, 0, {&sample, 1});
  EXPECT_EQ(splat(one.store, behind, one.object).stats.splats, 1);
  EXPECT_EQ(one.from(4).stats.splats, 1);
}

TEST(WarpAndSplat, AnObjectOnePixelWideHasItsOwnPixels) {
  View view = view_of_balls(64, 64);
  std::vector<uint32_t> object(64 * 64, 1);
  for (size_t y = 0; y < 64; y++) object[y * 64 + 30] = 2;
  SampleStore store;
  std::vector<CorrectiveSample> samples;
  for (int y = 0; y < 64; y++) {
    Ray ray = view_ray(view, 30.5f, float(y) + 0.5f);
    samples.push_back({2, level_of_pixel(store.grid, {30, y}), ray.origin + ray.direction * 3.0f,
                       vec3(0, 0, 1), number_words(float(y))});
  }
  add_samples(store, view, 0, samples);
  Picture picture = splat(store, view, object);
  EXPECT_EQ(picture.stats.pixels, 64);
  for (size_t i = 0; i < object.size(); i++)
    EXPECT_EQ(picture.color[i], number_words(object[i] == 2 ? float(i / 64) : -1));
}

TEST(WarpAndSplat, HundredsOfObjectsEachShowTheirOwn) {
  Stage stage;
  for (uint32_t i = 0; i < 400; i++)
    stage.balls.push_back({i + 1, vec3(float(i % 20) - 9.5f, float(i / 20) - 9.5f, 0) * 0.2f,
                           0.04f + 0.0003f * float(i)});
  View view = view_of_balls(300, 300, 0.1f, 6);
  SampleStore store = traced(stage, view);
  EXPECT_EQ(store.objects.size(), 400u);
  EXPECT_EQ(count_wrong(splat(store, view, stage.objects(view)), stage, view), 0);
  EXPECT_EQ(age_samples(store, view.position, 1).invalid, 0);
}

TEST(WarpAndSplat, WithoutSamplesNothingIsShownAndColoursStay) {
  SampleStore store;
  View view = view_of_balls(33, 17);
  Picture picture = splat(store, view, std::vector<uint32_t>(33 * 17, 1));
  EXPECT_EQ(picture.stats.samples + picture.stats.splats + picture.stats.pixels, 0);
  for (size_t i = 0; i < picture.level.size(); i++) {
    EXPECT_EQ(picture.level[i], 0);
    EXPECT_EQ(picture.color[i], number_words(-1));
  }
}

// The same without tiles, lanes or threads.
Picture plain_splat(const SampleStore& store, const View& view, std::span<const uint32_t> object) {
  Picture picture{std::vector<SampleWords>(object.size(), number_words(-1)),
                  std::vector<uint8_t>(object.size(), 0),
                  {}};
  std::vector<float> nearest(object.size());
  for (const ObjectSamples& samples : store.objects)
    for (size_t level = 0; level < samples.levels.size(); level++) {
      const LevelSamples& list = samples.levels[level];
      std::fill(nearest.begin(), nearest.end(), INFINITY);
      for (size_t i = 0; i < size_t(list.count()); i++) {
        Projected p = project_point(view, vec3(list.x[i], list.y[i], list.z[i]));
        float focal = float(view.height) / (2 * view.tan_half_fov);
        int full = footprint_side(store.grid, int(level) + 1);
        int side =
            std::clamp(int(std::lrint(list.width[i] * float(full) * focal / p.depth)), 1, 4 * full);
        int x0 = test::footprint_begin(int(std::floor(p.x)), side);
        int y0 = test::footprint_begin(int(std::floor(p.y)), side);
        for (int y = std::max(y0, 0); y < std::min(y0 + side, view.height); y++)
          for (int x = std::max(x0, 0); x < std::min(x0 + side, view.width); x++) {
            size_t at = size_t(y) * size_t(view.width) + size_t(x);
            if (object[at] != samples.object || p.depth >= nearest[at]) continue;
            nearest[at] = p.depth;
            picture.color[at] = list.words[i];
            picture.level[at] = uint8_t(level + 1);
          }
      }
    }
  return picture;
}

TEST(WarpAndSplat, TilesAndLanesAgreeWithAPlainLoop) {
  View view = view_of_balls(401, 203), now = view_of_balls(401, 203, 0.05f, 3.3f);
  now.middle = {0.21f, -0.13f};
  std::vector<uint32_t> object(401 * 203);
  for (size_t i = 0; i < object.size(); i++) object[i] = 1 + uint32_t(i / 7 % 3);
  std::vector<CorrectiveSample> samples;
  for (uint32_t i = 0; i < 20000; i++) {
    auto number = [&](uint32_t k) { return float(mix64(i * 8 + k) >> 40) * 0x1p-24f; };
    vec3 place = vec3(5 * number(0) - 2.5f, 2.4f * number(1) - 1.2f, number(2));
    samples.push_back({1 + i % 3,
                       1 + int(number(3) * 4),
                       place,
                       vec3(0, 0, 1),
                       {uint32_t(number(4) * 1e9f), i, 0, 0}});
  }
  SampleStore store;
  add_samples(store, view, 0, samples);
  Picture fast = splat(store, now, object), plain = plain_splat(store, now, object);
  // If a sample falls on the very border of a pixel, another rounding takes the next pixel.
  int differ = 0;
  for (size_t i = 0; i < object.size(); i++)
    differ += fast.color[i] != plain.color[i] || fast.level[i] != plain.level[i];
  EXPECT_LT(differ, 100);
  EXPECT_GT(fast.stats.pixels, 60000);
}

TEST(WarpAndSplat, TheNumberOfThreadsDoesNotMatter) {
  Stage stage = two_balls();
  View view = view_of_balls(300, 200), now = view_of_balls(300, 200, 0.1f, 3.5f);
  SampleStore store = traced(stage, view);
  add_samples(store, now, 1, stage.trace_level(now, store.grid, 3));
  std::vector<uint32_t> object = stage.objects(now);
  Picture many = splat(store, now, object);
  oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  Picture single = splat(store, now, object);
  EXPECT_TRUE(same(many, single));
  EXPECT_EQ(many.stats.pixels, single.stats.pixels);
}

}  // namespace
}  // namespace wellspring::test
