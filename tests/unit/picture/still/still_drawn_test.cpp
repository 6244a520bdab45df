// SPDX-License-Identifier: Apache-2.0
// Pictures at rest that are drawn: antialiased in time where nothing moves, sharp where something
// does.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "judge/compare.h"
#include "unit/picture/drawn_visit.h"

namespace wellspring::test {
namespace {

constexpr int width = 120, height = 90, pixels = width * height;

// A box with bars before its back wall that are thinner than a cell of light, and a ball that can
// be moved.
struct Still : Stage {
  View view = make_view(scene, {0, 0.25, 0.6}, 0, 0, 0.7f, width, height);
  using Stage::Stage;
  Frame truth() const { return Stage::truth(view, 256); }
};
Still make_still() { return Still(make_barred_box(vec3(0.7f), 0.012f)); }
Still make_still_with_ball() {
  Scene scene = make_barred_box(vec3(0.7f), 0.012f);
  Mesh ball = add_ball(scene, {-0.1f, 0.1f, 0.1f});
  return Still(std::move(scene), std::move(ball));
}

struct Visit : DrawnVisit {
  void step(const Still& stage, int budget) {
    DrawnVisit::step(stage, stage.view, budget, PictureOf::still);
  }
};

// Pixels that neighbours of another object touch, four of whose quarters do not all show the same.
std::vector<bool> edge_pixels(const Still& stage) {
  std::vector<bool> edge(pixels, false);
  for (int i = 0; i < pixels; i++) {
    uint32_t first = 0;
    for (int k = 0; k < 4; k++) {
      float x = float(i % width) + 0.25f + 0.5f * float(k % 2),
            y = float(i / width) + 0.25f + 0.5f * float(k / 2);
      Hit hit = stage.world->intersect(view_ray(stage.view, x, y));
      uint32_t object = hit.valid() ? stage.world->object_of(hit.instance) : 0;
      if (k == 0) first = object;
      edge[size_t(i)] = edge[size_t(i)] || object != first;
    }
  }
  return edge;
}

// Returns the frame as the eye sees it: nothing is brighter than white, not a lamp's edge.
Frame shown(Frame frame) {
  for (vec3& c : frame.color) c = min(c, vec3(1));
  return frame;
}

double error_at(const Frame& a, const Frame& b, const std::vector<bool>& at) {
  double sum = 0, count = 0;
  for (size_t i = 0; i < at.size(); i++)
    if (at[i]) {
      vec3 d = a.color[i] - b.color[i];
      sum += double(dot(d, d)), count += 3;
    }
  return std::sqrt(sum / count);
}

// Edges are smooth after few samples.
TEST(StillDrawn, EdgesAreAntialiasedInTime) {
  Still stage = make_still();
  Frame truth = stage.truth();
  std::vector<bool> edges = edge_pixels(stage);
  ASSERT_GT(std::count(edges.begin(), edges.end(), true), pixels / 20);
  Visit drawn;
  double first = 0;
  for (int i = 0; i < 24; i++) {
    drawn.step(stage, pixels / 8);
    if (i == 3) first = error_at(drawn.frame, truth, edges);
  }
  double error = error_at(drawn.frame, truth, edges);
  EXPECT_LT(error, 0.7 * first);
  EXPECT_LT(error, 0.12);
  EXPECT_LT(rmse(drawn.frame, truth), 0.045);
  // Nothing trembles when no more is learned.
  for (int i = 0; i < 32; i++) drawn.step(stage, 0);
  std::vector<vec3> before = shown(drawn.frame).color;
  drawn.step(stage, 0);
  std::vector<vec3> now = shown(drawn.frame).color;
  for (size_t i = 0; i < before.size(); i++) ASSERT_LT(length(now[i] - before[i]), 0.05f) << i;
}

// With more and more samples the picture becomes the reference.
TEST(StillDrawn, ConvergesToTheReference) {
  Still stage = make_still();
  Frame truth = stage.truth();
  Visit drawn;
  double error[3];
  for (int k = 0, i = 0; k < 3; k++) {
    for (; i < 12 << (2 * k); i++) drawn.step(stage, pixels / 4);
    error[k] = rmse(shown(drawn.frame), shown(truth));
  }
  EXPECT_LT(error[1], 0.8 * error[0]);
  EXPECT_LT(error[2], 0.8 * error[1]);
  EXPECT_LT(error[2], 0.012);  // white is 1; 48 samples a pixel, and noise of 256 in the reference
}

TEST(StillDrawn, WhatMovesIsWhereItIsAndLeavesNothing) {
  Still stage = make_still_with_ball();
  Visit visit;
  for (int i = 0; i < 20; i++) visit.step(stage, pixels / 8);
  uint32_t ball = uint32_t(stage.scene.objects.size() - 1);
  auto expect_ball = [&] {
    for (int i = 0; i < pixels; i++) {
      Hit hit = stage.world->intersect(
          view_ray(stage.view, float(i % width) + 0.5f, float(i / width) + 0.5f));
      bool there = hit.valid() && stage.world->object_of(hit.instance) == ball;
      // At the ball's rim, the object may be seen at another place of the pixel.
      bool rim = false;
      for (vec2 to : {vec2(0, 0), vec2(1, 0), vec2(0, 1), vec2(1, 1)}) {
        Hit corner = stage.world->intersect(
            view_ray(stage.view, float(i % width) + to.x, float(i / width) + to.y));
        rim |= corner.valid() && (stage.world->object_of(corner.instance) == ball) != there;
      }
      if (rim) continue;
      ASSERT_EQ(visit.frame.object[size_t(i)] == ball, there) << i % width << " " << i / width;
    }
  };
  expect_ball();
  for (int i = 0; i < 10; i++) {
    stage.push_ball(0.02f);
    visit.step(stage, pixels / 8);
    expect_ball();
  }
  // The ball's colour, a yellow that the walls have not, does not stay at its former place.
  Frame truth = stage.truth();
  for (int i = 0; i < 4; i++) visit.step(stage, pixels / 8);
  double yellow = 0, expected = 0;
  for (int y = 50; y < 70; y++)
    for (int x = 30; x < 50; x++) {
      auto tint = [](vec3 c) { return double(c.x + c.y - 2 * c.z); };
      size_t i = size_t(y * width + x);
      if (truth.object[i] == ball) continue;
      yellow += tint(visit.frame.color[i]), expected += tint(truth.color[i]);
    }
  EXPECT_NEAR(yellow, expected, 0.25 * std::abs(expected) + 4);
}

// This holds also if the other view was drawn only once.
TEST(StillDrawn, NothingOfAnotherViewRemains) {
  Still stage = make_still();
  Visit visit;
  for (int i = 0; i < 4; i++) visit.step(stage, pixels / 4);
  View box = stage.view;
  stage.view = make_view(stage.scene, {0, 0.25, 0.6}, float(pi), 0, 0.7f, width,
                         height);  // nothing is there
  visit.step(stage, pixels / 4);
  for (vec3 c : visit.frame.color) ASSERT_EQ(c, vec3(0));
  stage.view = box;
  visit.step(stage, pixels / 4);
  Frame once = visit.frame;
  double light = 0, again = 0;
  for (vec3 c : once.color) light += luminance(c);
  stage.view = make_view(stage.scene, {0, 0.25, 0.6}, float(pi), 0, 0.7f, width, height);
  visit.step(stage, pixels / 4);
  for (vec3 c : visit.frame.color) again += luminance(c);
  EXPECT_GT(light, 100);
  EXPECT_EQ(again, 0);
}

// Two seconds after a jump (two dozen pictures) nothing tells a visitor who was somewhere else
// before from one who was not: means over squares of eight pixels differ by chance alone. Student's
// t of eight visits each, 14 degrees of freedom; beyond 9.5 lies one in six million, so of 180
// squares one in 33,000 runs fails by chance.
TEST(StillDrawn, NothingOfAnotherViewRemainsInTheMean) {
  constexpr int visits = 8, pictures = 24, across = width / 8, down = height / 8;
  Still stage = make_still();
  View here = stage.view;
  View there = make_view(stage.scene, {0.05, 0.2, 0.5}, 0.25f, -0.1f, 0.9f, width, height);
  std::vector<dvec2> sum(across * down, dvec2(0)), sum2 = sum;
  for (int i = 0; i < visits; i++)
    for (int jumped = 0; jumped < 2; jumped++) {
      Visit visit;
      visit.tick = uint64_t(1000 * (2 * i + jumped) + 1);
      stage.view = there;
      for (int k = 0; jumped && k < pictures; k++) visit.step(stage, pixels / 4);
      stage.view = here;
      for (int k = 0; k < pictures; k++) visit.step(stage, pixels / 4);
      Frame seen = shown(visit.frame);
      for (int b = 0; b < across * down; b++) {
        double light = 0;
        for (int p = 0; p < 64; p++)
          light +=
              double(luminance(
                  seen.color[size_t((b / across * 8 + p / 8) * width + b % across * 8 + p % 8)])) /
              64;
        sum[size_t(b)][jumped] += light, sum2[size_t(b)][jumped] += light * light;
      }
    }
  for (size_t b = 0; b < sum.size(); b++) {
    dvec2 mean = sum[b] / double(visits), variance = (sum2[b] - sum[b] * mean) / double(visits - 1);
    double error =
        std::sqrt((variance.x + variance.y) / visits) + 1e-6;  // squares of the lamp do not vary
    EXPECT_LT(std::abs(mean.y - mean.x), 9.5 * error) << b;
  }
}

}  // namespace
}  // namespace wellspring::test
