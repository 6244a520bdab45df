// SPDX-License-Identifier: Apache-2.0
// What is about to come into view is asked for before.
#include "cache/plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "cache/broker.h"
#include "unit/cache/visit.h"

namespace wellspring::test {
namespace {

View turned(float yaw, float pitch = 0, vec3 eye = vec3(0, 1.5f, 2)) {
  vec3 way(std::sin(yaw) * std::cos(pitch), std::sin(pitch), -std::cos(yaw) * std::cos(pitch));
  return look_at(eye, eye + way, 60, 160, 90);
}

TEST(Extrapolate, GoesOnStraightAndRound) {
  View ahead = extrapolate(turned(0.1f), turned(0.13f, 0, vec3(0.1f, 1.5f, 1.9f)), 2);
  View wanted = turned(0.19f, 0, vec3(0.3f, 1.5f, 1.7f));
  EXPECT_LT(length(ahead.position - wanted.position), 1e-5f);
  EXPECT_GT(dot(ahead.forward, wanted.forward), 1 - 1e-6f);
  EXPECT_GT(dot(ahead.right, wanted.right), 1 - 1e-6f);
  EXPECT_NEAR(dot(ahead.up, ahead.forward), 0, 1e-6f);
  EXPECT_NEAR(length(ahead.up), 1, 1e-6f);
}

TEST(Extrapolate, CarriesTheWindowOn) {
  View before = turned(0.1f), now = before;
  now.position += vec3(0.1f, 0, 0), now.middle = vec2(-0.1f, 0.05f);
  View ahead = extrapolate(before, now, 2);
  EXPECT_NEAR(ahead.middle.x, -0.3f, 1e-6f);
  EXPECT_NEAR(ahead.middle.y, 0.15f, 1e-6f);
  EXPECT_NEAR(ahead.position.x, before.position.x + 0.3f, 1e-6f);
}

TEST(Extrapolate, StaysWhereThereIsNoMotionToGoOnWith) {
  View now = turned(0.4f, 0.2f);
  EXPECT_EQ(extrapolate(now, now, 3), now);
  EXPECT_EQ(extrapolate(turned(2), now, 3), now);          // a jump
  EXPECT_EQ(extrapolate(turned(0.4f + pi), now, 3), now);  // half a turn has no axis
  View nowhere = now;
  nowhere.position.y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(extrapolate(nowhere, now, 3), now);
  View smaller = now;
  smaller.width = 80;
  EXPECT_EQ(extrapolate(smaller, now, 3), now);
}

struct Cloud {
  PointCache points;
  View view = turned(0);
  std::vector<uint8_t> cells;
  std::vector<Request> requests;
  // A point in the middle of every pixel of the columns [from, to).
  Cloud(int from, int to, vec2 middle = vec2(0)) {
    view.middle = middle;
    resize_points(points, 160 * 90);
    uint32_t i = 0;
    for (int y = 0; y < 90; y++)
      for (int x = from; x < to; x++, i++) {
        vec3 p = view.position + view_ray(view, float(x) + 0.5f, float(y) + 0.5f).direction * 3.0f;
        points.x[i] = p.x, points.y[i] = p.y, points.z[i] = p.z;
        points.flags[i] = point_used;
        points.age[i] = 0;
      }
  }
};

TEST(Predict, AsksWhereNoPointFallsAndNowhereElse) {
  for (vec2 middle : {vec2(0), vec2(0.4f, -0.3f)}) {
    Cloud c(0, 120, middle);
    find_occupied(c.points, c.view, c.cells);
    ASSERT_EQ(c.cells.size(), size_t(40 * 23));
    for (int y = 0; y < 22; y++)
      for (int x = 0; x < 40; x++) EXPECT_EQ(c.cells[size_t(y * 40 + x)], x < 30) << x << " " << y;
    predict_requests(c.points, c.view, 100000, 5, c.cells, c.requests);
    EXPECT_EQ(c.requests.size(), size_t(10 * 23));
    std::set<int> asked;
    for (const Request& r : c.requests) {
      Projected at = project_point(c.view, r.ray.origin + r.ray.direction);
      EXPECT_GE(at.x, 119.99f);
      EXPECT_TRUE(at.x <= 160.01f && at.y >= -0.01f && at.y <= 90.01f);
      EXPECT_TRUE(asked.insert(int(at.y / 4) * 40 + int(at.x / 4)).second);
      EXPECT_EQ(r.pixel, no_pixel);
    }
  }
}

TEST(Predict, OfTooManyItTakesAnEvenChoiceThatChanges) {
  Cloud c(0, 80);
  auto chosen = [&](uint64_t seed) {
    c.requests.clear();
    predict_requests(c.points, c.view, 46, seed, c.cells, c.requests);
    EXPECT_EQ(c.requests.size(), 46u);
    std::vector<int> rows(23, 0);
    std::set<std::pair<int, int>> cells;
    for (const Request& r : c.requests) {
      Projected at = project_point(c.view, r.ray.origin + r.ray.direction);
      rows[size_t(std::clamp(at.y / 4, 0.0f, 22.0f))]++;
      cells.insert({int(at.x / 4), int(at.y / 4)});
    }
    for (int n : rows) EXPECT_NEAR(n, 2, 1);
    return cells;
  };
  EXPECT_NE(chosen(1), chosen(2));
  EXPECT_EQ(chosen(3), chosen(3));
  c.requests.clear();
  predict_requests(c.points, c.view, 0, 1, c.cells, c.requests);
  EXPECT_TRUE(c.requests.empty());
}

TEST(Predict, EvictedUnusedAndBrokenPointsOccupyNothing) {
  Cloud c(0, 160);
  for (uint32_t i = 0; i < 160 * 90; i++)
    if (i % 3 == 0) c.points.age[i] = evicted_age;
    else if (i % 3 == 1) c.points.flags[i] = 0;
    else c.points.x[i] = std::numeric_limits<float>::quiet_NaN();
  find_occupied(c.points, c.view, c.cells);
  for (uint8_t cell : c.cells) EXPECT_EQ(cell, 0);
}

// A camera that turns at 2 degrees a picture, answers a picture late: what its leading edge shows.
struct Edge {
  double guessed = 0, wrong = 0;  // shares of its pixels
};
Edge turn(bool predicts, int mismatch) {
  Visit v;
  Broker broker(
      {.piece = 64, .most_waiting = 1 << 16, .most_traced = 1 << 16, .most_answered = 1 << 16});
  constexpr int width = 160, height = 90, edge = 12;
  int budget = width * height / mismatch, pictures = 0;
  Edge result;
  View before;
  for (int i = 0; i < 90; i++) {
    View view = turned(float(i) * 2 * pi / 180);
    v.cache.resize(width, height);
    v.cache.move_points(v.world());
    land(broker.collect(), v.world(), 0, v.cache);
    v.cache.project(view);
    v.cache.attend();
    std::vector<Request> ahead;
    if (predicts && i > 0)
      v.cache.predict(extrapolate(before, view, 2), budget * 3 / 10, v.tick, ahead);
    v.cache.plan(view, budget - int(ahead.size()), v.tick++, v.requests);
    v.requests.insert(v.requests.end(), ahead.begin(), ahead.end());
    broker.ask(view, {}, v.requests);
    while (auto piece = broker.take()) {
      Answer answer{std::move(*piece), 0, {}};
      trace_room(v.room, answer.piece.requests, answer.samples);
      broker.answer(std::move(answer));
    }
    v.cache.reconstruct(view, v.frame);
    before = view;
    if (i < 30) continue;
    Frame truth = render_room(v.room, view, 1);
    pictures++;
    for (int y = 0; y < height; y++)
      for (int x = width - edge; x < width; x++) {
        size_t pixel = size_t(y * width + x);
        result.guessed += v.frame.confidence[pixel] <= 0;
        result.wrong += v.frame.object[pixel] != truth.object[pixel];
      }
  }
  result.guessed /= pictures * edge * height;
  result.wrong /= pictures * edge * height;
  return result;
}

TEST(Predict, ATurningCamerasLeadingEdgeIsKnownBefore) {
  for (int mismatch : {16, 64}) {
    Edge without = turn(false, mismatch), with = turn(true, mismatch);
    EXPECT_LT(with.guessed, 0.95 * without.guessed) << mismatch;
    EXPECT_LT(with.wrong, 0.8 * without.wrong) << mismatch;
  }
}

}  // namespace
}  // namespace wellspring::test
