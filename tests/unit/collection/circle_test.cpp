// SPDX-License-Identifier: Apache-2.0
#include "collection/circle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "unit/collection/made_sets.h"

namespace wellspring::test {
namespace {

// Returns a map that shows places in space as they look from above.
Layout from_above(const std::vector<dvec3>& places) {
  Layout layout;
  for (const dvec3& place : places) layout.places.emplace_back(place.x, place.y);
  return layout;
}

std::vector<dvec3> draw_disc(int count) {
  Rng random(8);
  std::vector<dvec3> places = {dvec3(0)};
  while (int(places.size()) < count) {
    const dvec3 place(2 * double(random.uniform()) - 1, 2 * double(random.uniform()) - 1, 0);
    if (glm::length(place) < 1) places.push_back(place);
  }
  return places;
}

TEST(Circle, IsItsOwnBallWhereTheMapIsTrue) {
  const auto places = draw_disc(200);
  const CircleMeaning meaning = read_circle(from_above(places), distances_of(places), 0, 0.5);
  EXPECT_TRUE(meaning.outliers.empty());
  EXPECT_NEAR(meaning.mean, 1, 1e-12);
  double farthest = 0;
  size_t count = 0;
  for (const dvec3& place : places)
    if (glm::length(place) <= 0.5) farthest = std::max(farthest, glm::length(place)), count++;
  EXPECT_EQ(meaning.inside.size(), count);
  EXPECT_NEAR(meaning.ball, farthest, 1e-12);
}

TEST(Circle, DoesNotHoldWhatTheMapShowsTooNear) {
  auto places = draw_disc(200);
  const CircleMeaning plain = read_circle(from_above(places), distances_of(places), 0, 0.5);
  std::vector<int> planted;
  for (int i = 0; i < 5; i++) {
    planted.push_back(int(places.size()));
    places.emplace_back(0.1 * i - 0.2, 0.05 * i, i % 2 ? 3 : -3);
  }
  const CircleMeaning meaning = read_circle(from_above(places), distances_of(places), 0, 0.5);
  EXPECT_EQ(meaning.outliers, planted);
  EXPECT_NEAR(meaning.ball, plain.ball, 1e-12);
}

TEST(Circle, TheShareOfTheMostSimilarNarrowsTheBall) {
  const auto places = draw_disc(200);
  const Layout layout = from_above(places);
  const Distances distances = distances_of(places);
  const double whole = read_circle(layout, distances, 0, 0.8).ball;
  const double half = read_circle(layout, distances, 0, 0.8, {.lambda = 0.5}).ball;
  EXPECT_LT(half, 0.8 * whole);
  EXPECT_GT(half, 0.5 * whole);
  EXPECT_EQ(read_circle(layout, distances, 0, 0.8, {.lambda = 0}).ball, 0);
}

TEST(Circle, AroundOneAloneHoldsIt) {
  const auto places = draw_disc(20);
  const CircleMeaning meaning = read_circle(from_above(places), distances_of(places), 3, 0);
  EXPECT_EQ(meaning.inside, std::vector<int>{3});
  EXPECT_EQ(meaning.ball, 0);
}

TEST(Circle, ABallHoldsWhomAllDistancesSay) {
  Rng random(11);
  std::vector<SetItem> items;
  for (int i = 0; i < 700; i++) {
    SetItem item = draw_set(random, 4, 12);
    const double shift = double(i % 7);  // groups
    for (double& number : item.points) number += shift;
    items.push_back(item);
  }
  items.push_back(items[5]);  // an equal
  const Sets sets(items, 4);
  std::vector<int> all(items.size());
  std::iota(all.begin(), all.end(), 0);
  for (const int pivot : {5, 100, 432}) {
    std::vector<std::pair<double, int>> far;
    for (const int i : all) far.emplace_back(distance_of(sets, pivot, i), i);
    std::ranges::sort(far);
    for (const size_t count : {1, 2, 60, 350, 701}) {
      const double ball = far[count - 1].first;  // one lies on its surface
      std::vector<int> truth;
      for (const auto& [distance, i] : far)
        if (distance <= ball) truth.push_back(i);
      std::ranges::sort(truth);
      BallCost cost;
      EXPECT_EQ(select_ball(sets, all, pivot, ball, &cost), truth) << pivot << " " << count;
      EXPECT_EQ(cost.asked, 701);
      EXPECT_GE(cost.computed, int(truth.size()));
      if (count == 60) {
        EXPECT_LT(cost.computed, 350);
      }
    }
  }
}

}  // namespace
}  // namespace wellspring::test
