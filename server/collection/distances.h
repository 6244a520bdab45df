// SPDX-License-Identifier: Apache-2.0
// All distances of some items, for maps and clusters.
#pragma once
#include <span>
#include <vector>

#include "collection/set_item.h"

namespace wellspring::collection {

struct Distances {
  int count = 0;
  std::vector<double> pairs;  // (i, k) of i > k at i * (i - 1) / 2 + k
  double at(int i, int k) const {
    if (i < k) return at(k, i);
    return i == k ? 0 : pairs[size_t(i) * size_t(i - 1) / 2 + size_t(k)];
  }
};

// Returns the distances of these items of `sets`, on all cores.
Distances find_distances(const Sets& sets, std::span<const int> items);

}  // namespace wellspring::collection
