// SPDX-License-Identifier: Apache-2.0
// Groups items around some of them: CLARA (Kaufman, Rousseeuw 1990), which partitions samples
// around medoids (PAM) and keeps those that serve all items best.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "collection/set_item.h"

namespace wellspring::collection {

struct Clusters {
  std::vector<int> medoids;  // items, by the size of their cluster, largest first
  std::vector<int> of;       // each item's cluster: an index into `medoids`
  double cost = 0;           // sum of the distances to the medoids
};

// Groups `count` items into at most `most` clusters; fewer where items are equal. `distance` must
// be fit for several threads. The same seed gives the same clusters.
Clusters find_clusters(int count, int most, const std::function<double(int, int)>& distance,
                       uint64_t seed, int draws = 5);

// Returns for each of `items` which of `medoids` is the nearest; the first of equally near ones.
// Means of sets save most distances.
std::vector<int> nearest_medoids(const Sets& sets, std::span<const int> items,
                                 std::span<const int> medoids);

}  // namespace wellspring::collection
