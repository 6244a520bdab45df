// SPDX-License-Identifier: Apache-2.0
#include "lawn/draw_lawn.h"

#include <gtest/gtest.h>

#include <oneapi/tbb/global_control.h>

#include "made.h"

namespace wellspring::test {
namespace {

const Wind still{.strength = 0};

LawnView view_of(int width, int height, vec3 eye = {0, 0.5f, 3}) {
  LawnView view;
  view.eye = eye;
  view.width = width, view.height = height;
  view.axis = 0.5f * vec2(width, height);
  return view;
}

LawnPicture drawn(const Lawn& lawn, const LawnView& view, const LawnDrawSettings& settings = {},
                  LawnCounts* counts = nullptr) {
  LawnPicture picture;
  LawnDrawer drawer;
  const LawnCounts found = drawer.draw(lawn, make_lawn_state(lawn), still, view, settings, picture);
  if (counts) *counts = found;
  return picture;
}

// Makes one upright blade, or a few, as wide as it is told, that faces the eye.
Lawn upright(float length, float width, std::vector<vec3> roots = {vec3(0)}) {
  LawnDescription description;
  description.low = {-0.5f, -0.5f}, description.high = {0.5f, 0.5f};
  description.density = 8, description.droop = 0, description.messiness.constant = vec3(0);
  description.height = length;
  Lawn lawn = make_lawn(description);
  const int first = lawn.tile[0].begin;
  for (size_t i = 0; i < 8; i++) {
    const size_t k = size_t(first) + i;
    const bool there = i < roots.size();
    lawn.length[k] = there ? length : 0, lawn.width[k] = width;
    if (there) lawn.x[k] = roots[i].x, lawn.y[k] = roots[i].y, lawn.z[k] = roots[i].z;
    lawn.side_x[k] = 1, lawn.side_z[k] = 0, lawn.droop[k] = 0;
  }
  for (size_t k = size_t(first) + 8; k < lawn.length.size(); k++) lawn.length[k] = 0;
  lawn.tile[0].count = 8, lawn.tile[0].widest = width;
  lawn.tile[0].low = vec3(-1), lawn.tile[0].high = vec3(1);
  return lawn;
}

double sum(const std::vector<float>& plane) {
  double total = 0;
  for (const float x : plane) total += x;
  return total;
}

// Wide blades are filled segment by segment, thin ones at once; upright ones row by row, and those
// that lie in the picture column by column.
TEST(DrawLawn, BladeIsWhereItIsProjected) {
  for (const float width : {0.04f, 0.01f})
    for (const bool coverage : {false, true})
      for (const bool lies : {false, true}) {
        const Lawn lawn = upright(0.4f, width);
        LawnView view = view_of(200, 200, {0, 0.2f, 1});  // 200 pixels a metre
        if (lies) view.right = {0, 1, 0}, view.up = {-1, 0, 0};
        const LawnPicture picture = drawn(lawn, view, {.coverage = coverage});
        // Its thirds are 80 / 3 pixels long; their widths go from 0.75 to 1, to 0.7 and to 0.
        const double pixels = 200 * width, area = 80.0 / 3 * pixels * (0.875 + 0.85 + 0.35);
        EXPECT_NEAR(sum(picture.coverage), area, (coverage ? 0.02 : 0.12) * area);
        for (int y = 0; y < 200; y++)
          for (int x = 0; x < 200; x++) {
            const size_t i = size_t(y * 200 + x);
            if (picture.coverage[i] == 0) {
              EXPECT_EQ(picture.depth[i], INFINITY);
              EXPECT_EQ(picture.color[i], vec3(0));
              continue;
            }
            const float across = (lies ? float(y) : float(x)) + 0.5f - 100,
                        along = lies ? float(x) + 0.5f - 60 : 140 - (float(y) + 0.5f);
            EXPECT_LE(std::abs(across), 0.5f * float(pixels) + 0.6f);
            EXPECT_GE(along, 0);
            EXPECT_LE(along, 80);
            EXPECT_NEAR(picture.depth[i], 1, 1e-4f);
            EXPECT_NEAR(picture.height_share[i], along / 80, 0.01f);
            EXPECT_NEAR(glm::length(picture.normal[i]), 1, 1e-4f);
            EXPECT_GT(picture.normal[i].z, 0.7f);  // towards the eye
            EXPECT_GE(picture.sway[i], 0);
            EXPECT_GT(picture.color[i].y, picture.color[i].x);
          }
      }
}

TEST(DrawLawn, NormalsTurnWithTheEdgeThatTheyBelongTo) {
  Lawn lawn = upright(0.4f, 0.04f);
  for (const float side : {1.0f, -1.0f})
    for (const bool lies : {false, true}) {
      lawn.side_x[size_t(lawn.tile[0].begin)] = side;
      LawnView view = view_of(50, 50, {0, 0.2f, 1});
      if (lies) view.right = {0, 1, 0}, view.up = {-1, 0, 0};
      // 2 pixels wide: it is a thin one, whose edge to the picture's left or top is first.
      const LawnPicture picture = drawn(lawn, view);
      const size_t first = lies ? 24 * 50 + 25 : 25 * 50 + 24,
                   second = lies ? first + 50 : first + 1;
      EXPECT_LT(picture.normal[first].x, -0.1f);
      EXPECT_GT(picture.normal[second].x, 0.1f);
    }
}

TEST(DrawLawn, NormalsAreRoundAcrossABlade) {
  const Lawn lawn = upright(0.4f, 0.1f);
  const LawnPicture picture = drawn(lawn, view_of(200, 200, {0, 0.2f, 1}));
  EXPECT_LT(picture.normal[100 * 200 + 92].x, -0.3f);
  EXPECT_GT(picture.normal[100 * 200 + 107].x, 0.3f);
}

TEST(DrawLawn, NearerBladeHidesAndThinOnesAddUp) {
  Lawn lawn = upright(0.4f, 0.05f, {vec3(0, 0, -0.2f), vec3(0, 0, 0.2f)});
  const LawnView view = view_of(100, 100, {0, 0.2f, 1.2f});
  for (const bool coverage : {false, true})
    EXPECT_NEAR(drawn(lawn, view, {.coverage = coverage}).depth[50 * 100 + 50], 1, 1e-4f);
  // A blade of a quarter of a pixel covers that, and two cover 1 - 0.75^2 where both are.
  for (const int blades : {1, 2}) {
    std::vector<vec3> roots(size_t(blades), vec3(0));
    lawn = upright(0.4f, 0.25f / 100, roots);
    LawnView beside = view_of(100, 100, {0, 0.2f, 1});
    beside.axis.x = 50.5f;
    const LawnPicture picture = drawn(lawn, beside, {.least_width = 0.01f});
    EXPECT_NEAR(picture.coverage[56 * 100 + 50], blades == 1 ? 0.25f : 0.4375f, 0.01f);
  }
}

TEST(DrawLawn, CoverageIsTheMeanOfSamples) {
  const Lawn lawn = make_lawn(small_meadow());
  LawnView view = view_of(160, 90);
  const LawnPicture soft = drawn(lawn, view);
  std::vector<double> mean(soft.coverage.size());
  constexpr int samples = 64;
  for (int i = 0; i < samples; i++) {
    view.offset = (vec2(i % 8, i / 8) + 0.5f) / 8.0f;
    const LawnPicture exact = drawn(lawn, view, {.coverage = false});
    for (size_t k = 0; k < mean.size(); k++) {
      EXPECT_TRUE(exact.coverage[k] == 0 || exact.coverage[k] == 1);
      mean[k] += exact.coverage[k] / samples;
    }
  }
  double off = 0, all = 0, signed_off = 0;
  for (size_t k = 0; k < mean.size(); k++) {
    off += std::abs(mean[k] - soft.coverage[k]), all += mean[k];
    signed_off += soft.coverage[k] - mean[k];
  }
  EXPECT_GT(all, 1000);
  EXPECT_LT(off / all, 0.15);
  EXPECT_LT(std::abs(signed_off) / all, 0.03);
}

TEST(DrawLawn, WhatStandsBeforeHidesGrass) {
  const Lawn lawn = make_lawn(small_meadow());
  const LawnView view = view_of(160, 90);
  const LawnPicture open = drawn(lawn, view);
  std::vector<float> before(160 * 90, INFINITY);
  for (int y = 0; y < 90; y++)
    for (int x = 0; x < 80; x++) before[size_t(y * 160 + x)] = 2;
  const LawnPicture half = drawn(lawn, view, {.before = before});
  for (size_t i = 0; i < before.size(); i++) {
    if (i % 160 < 80) {
      EXPECT_TRUE(half.depth[i] <= 2 || half.depth[i] == INFINITY);
    } else {
      EXPECT_EQ(half.depth[i], open.depth[i]);
      EXPECT_EQ(half.coverage[i], open.coverage[i]);
    }
  }
  std::ranges::fill(before, 0.1f);
  LawnCounts counts;
  EXPECT_EQ(sum(drawn(lawn, view, {.before = before}, &counts).coverage), 0);
  EXPECT_EQ(counts.tiles, 0);
}

TEST(DrawLawn, TilesOutOfSightAreLeftOut) {
  const Lawn lawn = make_lawn(small_meadow());
  LawnCounts ahead, behind, inside, below;
  drawn(lawn, view_of(160, 90), {}, &ahead);
  drawn(lawn, view_of(160, 90, {0, 0.5f, -6}), {}, &behind);
  const LawnPicture within = drawn(lawn, view_of(160, 90, {0, 0.3f, 0}), {}, &inside);
  drawn(lawn, view_of(160, 90, {0, 90, 3}), {}, &below);
  EXPECT_GT(ahead.blades, 500);
  EXPECT_EQ(behind.tiles, 0);
  EXPECT_GT(inside.tiles, 0);
  EXPECT_LT(inside.tiles, ahead.tiles);
  EXPECT_GT(sum(within.coverage), 0);
  EXPECT_EQ(below.tiles, 0);
}

TEST(DrawLawn, NearCutsAway) {
  const Lawn lawn = make_lawn(small_meadow());
  LawnView view = view_of(160, 90);
  view.near = 2.5f;
  const LawnPicture picture = drawn(lawn, view);
  EXPECT_GT(sum(picture.coverage), 0);
  for (const float depth : picture.depth) EXPECT_GE(depth, 2.5f);
}

TEST(DrawLawn, FarGrassIsFewerBladesOfTheSameArea) {
  LawnDescription description = small_meadow();
  description.density = 2000;
  const Lawn lawn = make_lawn(description);
  const LawnView view = view_of(320, 180, {0, 2, 12});
  LawnCounts all, few;
  const double full = sum(drawn(lawn, view, {.least_width = 1e-3f}, &all).coverage),
               less = sum(drawn(lawn, view, {.least_width = 0.3f}, &few).coverage);
  EXPECT_LT(few.blades, 0.6 * all.blades);
  EXPECT_NEAR(less, full, 0.15 * full);
}

TEST(DrawLawn, NothingJumpsWhenTheEyeComesNearer) {
  const Lawn lawn = make_lawn(small_meadow());
  // Coverage changes with each step by little, also where blades come to those that are drawn.
  const auto at = [&](float z) { return drawn(lawn, view_of(160, 90, {0, 1, z})).coverage; };
  std::vector<float> before = at(9);
  for (int i = 1; i <= 20; i++) {
    const std::vector<float> now = at(9 - 2e-4f * float(i));
    float most = 0;
    for (size_t k = 0; k < now.size(); k++) most = std::max(most, std::abs(now[k] - before[k]));
    EXPECT_LT(most, 0.3f) << i;
    before = now;
  }
}

TEST(DrawLawn, BitsAreTheSameForAnyNumberOfThreads) {
  const Lawn lawn = make_lawn(small_meadow());
  const LawnView view = view_of(200, 120);
  const LawnPicture many = drawn(lawn, view);
  oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  const LawnPicture one = drawn(lawn, view);
  EXPECT_EQ(many.depth, one.depth);
  EXPECT_EQ(many.normal, one.normal);
  EXPECT_EQ(many.color, one.color);
  EXPECT_EQ(many.coverage, one.coverage);
}

TEST(DrawLawn, BentBladesAreDrawnWhereTheyLie) {
  const Lawn lawn = upright(0.4f, 0.04f);
  LawnState state = make_lawn_state(lawn);
  step_lawn(state, lawn, still, ball({-0.3f, 0.3f, 0}, 0.4f), 1);
  LawnPicture picture;
  LawnDrawer drawer;
  drawer.draw(lawn, state, still, view_of(200, 200, {0, 0.2f, 1}), {}, picture);
  EXPECT_EQ(picture.coverage[size_t(90 * 200 + 100)], 0);
  EXPECT_GT(sum(picture.coverage), 50);
}

TEST(DrawLawn, HardViewsAndLawnsAreHarmless) {
  const Lawn lawn = make_lawn(small_meadow());
  LawnView view = view_of(64, 48);
  const auto count = [&](auto change) {
    LawnView changed = view;
    change(changed);
    const LawnPicture picture = drawn(lawn, changed);
    for (const float c : picture.coverage) EXPECT_TRUE(c >= 0 && c <= 1);
    for (const vec3& n : picture.normal) EXPECT_TRUE(is_finite(n));
    return picture.coverage.size();
  };
  EXPECT_EQ(count([](LawnView& v) { v.width = 0; }), 0u);
  EXPECT_EQ(count([](LawnView& v) { v.height = 1 << 20; }), 0u);
  EXPECT_EQ(count([](LawnView& v) { v.eye.x = NAN; }), 0u);
  EXPECT_EQ(count([](LawnView& v) { v.tan_half_fov = 0; }), 0u);
  EXPECT_EQ(count([](LawnView& v) { v.width = v.height = 1, v.axis = vec2(0.5f); }), 1u);
  EXPECT_EQ(count([](LawnView& v) { v.eye = {0, 0.01f, 0}; }), 64u * 48);
  EXPECT_EQ(count([](LawnView& v) { v.forward = {0, -1, 0}, v.up = {0, 0, -1}; }), 64u * 48);
  EXPECT_EQ(count([](LawnView& v) { v.axis = {-500, 900}; }), 64u * 48);
  EXPECT_EQ(drawn(Lawn(), view).coverage, std::vector<float>(64 * 48));
  // After a kilometre's sphere blades reach far over the picture.
  LawnState state = make_lawn_state(lawn);
  step_lawn(state, lawn, still, ball({30, -900, 10}, 1000), 1);
  LawnPicture picture;
  LawnDrawer().draw(lawn, state, still, view, {}, picture);
  for (const float c : picture.coverage) EXPECT_TRUE(c >= 0 && c <= 1);
}

}  // namespace
}  // namespace wellspring::test
