// SPDX-License-Identifier: Apache-2.0
#include "collection/set_item.h"

#include <gtest/gtest.h>

#include <numeric>

#include "unit/collection/made_sets.h"

namespace wellspring::test {
namespace {

// Returns Mahalanobis' distance of two pairs by the inverse of their covariance of two rows.
double mahalanobis(const std::vector<double>& points, size_t i, size_t k) {
  const size_t n = points.size() / 2;
  double mean[2] = {}, xx = 0, xy = 0, yy = 0;
  for (size_t j = 0; j < 2 * n; j++) mean[j % 2] += points[j] / double(n);
  for (size_t j = 0; j < n; j++) {
    const double x = points[2 * j] - mean[0], y = points[2 * j + 1] - mean[1];
    xx += x * x / double(n), xy += x * y / double(n), yy += y * y / double(n);
  }
  const double x = points[2 * i] - points[2 * k], y = points[2 * i + 1] - points[2 * k + 1];
  const double determinant = xx * yy - xy * xy;
  return std::sqrt((yy * x * x - 2 * xy * x * y + xx * y * y) / determinant);
}

TEST(SetItem, TheGroundDistanceIsMahalanobis) {
  Rng random(1);
  std::vector<double> points;
  std::vector<SetItem> items;
  for (int i = 0; i < 40; i++) {
    // Ranges and correlation are very different.
    const double x = 1000 * double(random.uniform());
    points.insert(points.end(), {x, 0.001 * x + 0.2 * double(random.uniform())});
    items.push_back({{points[points.size() - 2], points.back()}, {1}});
  }
  const Sets sets(items, 2);
  for (int i = 0; i < 40; i++)
    for (int k = 0; k < i; k++)
      EXPECT_NEAR(distance_of(sets, i, k), mahalanobis(points, size_t(i), size_t(k)), 1e-5);
}

TEST(SetItem, PropertiesThatAreAlwaysTheSameDoNotCount) {
  std::vector<SetItem> items;
  for (int i = 0; i < 5; i++) items.push_back({{1e6 + 0.1, double(i), 2.0 * i}, {1}});
  const Sets sets(items, 3);
  EXPECT_EQ(sets.dims(), 1);  // the third is twice the second
  EXPECT_NEAR(distance_of(sets, 0, 4), 4 * distance_of(sets, 2, 3), 1e-6);

  const Sets equal(std::vector<SetItem>(4, SetItem{{1, 2, 1, 2}, {1, 3}}), 2);
  EXPECT_EQ(equal.dims(), 0);
  EXPECT_EQ(distance_of(equal, 0, 3), 0);
}

TEST(SetItem, MassesSumToOneExactly) {
  Rng random(2);
  std::vector<SetItem> items;
  for (int i = 0; i < 100; i++) items.push_back(draw_set(random, 2, 14));
  const Sets sets(items, 2);
  for (int i = 0; i < sets.size(); i++) {
    const SetView set = sets[i];
    EXPECT_EQ(std::accumulate(set.masses, set.masses + set.count, 0.0), 1);
    for (int k = 0; k < set.count; k++) EXPECT_GT(set.masses[k], 0);
  }
}

TEST(SetItem, NearestPointsAreMergedWhereThereAreTooMany) {
  SetItem item{{0, 0.1, 5, 9, 9.3}, {1, 3, 2, 1, 1}};
  merge_nearest(item, 1, 3);
  ASSERT_EQ(item.masses.size(), 3u);
  EXPECT_NEAR(item.points[0], 0.075, 1e-12);
  EXPECT_NEAR(item.masses[0], 4, 1e-12);
  EXPECT_NEAR(item.points[2], 9.15, 1e-12);

  Rng random(3);
  std::vector<SetItem> items;
  for (int i = 0; i < 10; i++) items.push_back(draw_set(random, 3, 60));
  const Sets sets(items, 3);
  for (int i = 0; i < sets.size(); i++) EXPECT_LE(sets[i].count, most_points);
}

}  // namespace
}  // namespace wellspring::test
