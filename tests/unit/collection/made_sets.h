// SPDX-License-Identifier: Apache-2.0
// Sets and distances of tests of collections.
#pragma once
#include <cmath>
#include <vector>

#include "base/rng.h"
#include "base/vec.h"
#include "collection/distances.h"
#include "collection/earth_mover.h"
#include "collection/set_item.h"

namespace wellspring::test {

// Draws a set of 1 to `most` points in a cube, with masses that differ unless `even`.
inline SetItem draw_set(Rng& random, int properties, int most, bool even = false) {
  SetItem item;
  const int count = 1 + int(random.next() % uint32_t(most));
  for (int i = 0; i < count * properties; i++) item.points.push_back(double(random.uniform()));
  for (int i = 0; i < count; i++) item.masses.push_back(even ? 1 : 0.05 + double(random.uniform()));
  return item;
}

inline double distance_of(const Sets& sets, int i, int k) {
  return earth_mover(sets[i], sets[k], sets.dims());
}

// Returns the distances of places, as if they were those of items.
template <class Place>
Distances distances_of(const std::vector<Place>& places) {
  Distances distances;
  distances.count = int(places.size());
  for (size_t i = 0; i < places.size(); i++)
    for (size_t k = 0; k < i; k++) distances.pairs.push_back(glm::distance(places[i], places[k]));
  return distances;
}

}  // namespace wellspring::test
