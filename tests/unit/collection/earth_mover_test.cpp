// SPDX-License-Identifier: Apache-2.0
#include "collection/earth_mover.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "unit/collection/made_sets.h"

namespace wellspring::test {
namespace {

// Returns the area between the two sets' distribution functions, along the one axis there is.
double area_between(const SetView& a, const SetView& b) {
  std::map<double, double> steps;
  for (int i = 0; i < a.count; i++) steps[double(a.rows[i])] += a.masses[i];
  for (int i = 0; i < b.count; i++) steps[double(b.rows[i])] -= b.masses[i];
  double area = 0, level = 0, before = 0;
  for (const auto& [at, step] : steps) {
    area += std::abs(level) * (at - before);
    level += step, before = at;
  }
  return area;
}

TEST(EarthMover, IsTheAreaBetweenDistributionsOnALine) {
  Rng random(3);
  std::vector<SetItem> items;
  for (int i = 0; i < 60; i++) items.push_back(draw_set(random, 1, most_points));
  const Sets sets(items, 1);
  ASSERT_EQ(sets.dims(), 1);
  for (int i = 0; i < sets.size(); i++)
    for (int k = 0; k < sets.size(); k++)
      EXPECT_NEAR(distance_of(sets, i, k), area_between(sets[i], sets[k]), 1e-12);
}

TEST(EarthMover, IsTheBestAssignmentOfEvenSets) {
  Rng random(4);
  for (int size = 1; size <= 7; size++) {
    std::vector<SetItem> items(2);
    for (SetItem& item : items) {
      for (int i = 0; i < size * 3; i++) item.points.push_back(double(random.uniform()));
      item.masses.assign(size_t(size), 1);
    }
    const Sets sets(items, 3);
    const SetView a = sets[0], b = sets[1];
    std::vector<int> order(static_cast<size_t>(size));
    std::iota(order.begin(), order.end(), 0);
    double best = INFINITY;
    do {
      double sum = 0;
      for (int i = 0; i < size; i++) {
        double square = 0;
        for (int d = 0; d < sets.dims(); d++) {
          const double off =
              double(a.rows[d * a.stride + i]) - double(b.rows[d * b.stride + order[size_t(i)]]);
          square += off * off;
        }
        sum += std::sqrt(square) / size;
      }
      best = std::min(best, sum);
    } while (std::ranges::next_permutation(order).found);
    EXPECT_NEAR(distance_of(sets, 0, 1), best, 1e-9) << size;
  }
}

TEST(EarthMover, IsAMetric) {
  Rng random(5);
  std::vector<SetItem> items;
  for (int i = 0; i < 24; i++) items.push_back(draw_set(random, 4, most_points, i % 2 == 0));
  items.push_back(items[3]);  // equal sets are no way apart
  const Sets sets(items, 4);
  for (int i = 0; i < sets.size(); i++) {
    EXPECT_NEAR(distance_of(sets, i, i), 0, 1e-12);
    for (int k = 0; k < sets.size(); k++) {
      EXPECT_NEAR(distance_of(sets, i, k), distance_of(sets, k, i), 1e-12);
      for (int j = 0; j < sets.size(); j++)
        EXPECT_LE(distance_of(sets, i, k),
                  distance_of(sets, i, j) + distance_of(sets, j, k) + 1e-12);
    }
  }
  EXPECT_NEAR(distance_of(sets, 3, sets.size() - 1), 0, 1e-12);
  EXPECT_GT(distance_of(sets, 3, 4), 0.01);
}

TEST(EarthMover, MeansAreNeverFartherApart) {
  Rng random(6);
  std::vector<SetItem> items;
  for (int i = 0; i < 80; i++) items.push_back(draw_set(random, 5, 12));
  const Sets sets(items, 5);
  for (int i = 0; i < sets.size(); i++)
    for (int k = 0; k < i; k++)
      EXPECT_LE(mean_distance(sets[i], sets[k], sets.dims()), distance_of(sets, i, k) + 1e-12);
}

TEST(EarthMover, StopsOnlyWhereItIsFarther) {
  Rng random(7);
  std::vector<SetItem> items;
  for (int i = 0; i < 60; i++) items.push_back(draw_set(random, 3, most_points));
  const Sets sets(items, 3);
  for (int i = 0; i < sets.size(); i++)
    for (int k = 0; k < i; k++) {
      const double whole = distance_of(sets, i, k);
      for (const double part : {0.3, 0.9, 1.0, 1.1}) {
        const double enough = part * whole;
        const double told = earth_mover(sets[i], sets[k], sets.dims(), enough);
        if (part >= 1) EXPECT_EQ(told, whole);
        else EXPECT_GT(told, enough);
        EXPECT_LE(told, whole + 1e-12);
      }
    }
}

// Moved masses are whole numbers of a unit, so that sets which differ by one are no trap.
TEST(EarthMover, MassesOfVeryDifferentSizesAreMoved) {
  std::vector<SetItem> items(2);
  items[0] = {{0, 1, 2, 3}, {1e-9, 1, 1e9, 1e-12}};
  items[1] = {{0.5, 1.5, 2.5}, {1e9, 1e-9, 1}};
  const Sets sets(items, 1);
  EXPECT_NEAR(distance_of(sets, 0, 1), area_between(sets[0], sets[1]), 1e-12);
}

}  // namespace
}  // namespace wellspring::test
