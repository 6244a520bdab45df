// SPDX-License-Identifier: Apache-2.0
#include "collection/clusters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "unit/collection/made_sets.h"

namespace wellspring::test {
namespace {

// Returns places in groups of different sizes: item i belongs to group i % 10 in 0 0 0 0 1 1 1 2
// 2 3.
std::vector<dvec2> draw_groups(int count) {
  const dvec2 middles[] = {{0, 0}, {5, 0}, {0, 6}, {8, 8}};
  const int groups[] = {0, 0, 0, 0, 1, 1, 1, 2, 2, 3};
  Rng random(3);
  std::vector<dvec2> places;
  for (int i = 0; i < count; i++)
    places.push_back(middles[groups[i % 10]] +
                     dvec2(double(random.uniform()), double(random.uniform())));
  return places;
}

TEST(Clusters, GroupsAreFound) {
  const auto places = draw_groups(1000);
  const Distances distances = distances_of(places);
  auto distance = [&](int i, int k) { return distances.at(i, k); };
  const Clusters clusters = find_clusters(1000, 4, distance, 1);
  ASSERT_EQ(clusters.medoids.size(), 4u);
  const int groups[] = {0, 0, 0, 0, 1, 1, 1, 2, 2, 3};
  for (int i = 0; i < 1000; i++) EXPECT_EQ(clusters.of[size_t(i)], groups[i % 10]);
  EXPECT_EQ(find_clusters(1000, 4, distance, 1).medoids, clusters.medoids);
}

TEST(Clusters, EqualItemsAreOneCluster) {
  const Clusters equal = find_clusters(
      100, 6, [](int, int) { return 0.0; }, 1);
  EXPECT_EQ(equal.medoids.size(), 1u);
  EXPECT_EQ(equal.cost, 0);
  const Clusters two = find_clusters(
      9, 6, [](int i, int k) { return i % 2 == k % 2 ? 0. : 1.; }, 1);
  EXPECT_EQ(two.medoids.size(), 2u);
  EXPECT_EQ(std::ranges::count(two.of, 0), 5);
  EXPECT_EQ(find_clusters(
                1, 6, [](int, int) { return 0.0; }, 1)
                .of,
            std::vector<int>{0});
  EXPECT_TRUE(find_clusters(
                  0, 6, [](int, int) { return 0.0; }, 1)
                  .medoids.empty());
}

TEST(Clusters, MeansFindTheNearestMedoidsThatAllDistancesFind) {
  Rng random(12);
  std::vector<SetItem> items;
  for (int i = 0; i < 300; i++) items.push_back(draw_set(random, 3, 10));
  const Sets sets(items, 3);
  std::vector<int> all(items.size());
  std::iota(all.begin(), all.end(), 0);
  const std::vector<int> medoids = {7, 40, 41, 200, 7};
  const std::vector<int> found = nearest_medoids(sets, all, medoids);
  for (const int i : all) {
    int best = 0;
    for (int k = 0; k < int(medoids.size()); k++)
      if (distance_of(sets, i, medoids[size_t(k)]) < distance_of(sets, i, medoids[size_t(best)]))
        best = k;
    EXPECT_EQ(found[size_t(i)], best) << i;
  }
}

}  // namespace
}  // namespace wellspring::test
