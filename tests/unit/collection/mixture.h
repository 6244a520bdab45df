// SPDX-License-Identifier: Apache-2.0
// A made collection of groups within groups: the smaller the group, the fewer ways its objects
// differ in, so that maps of it can be truer.
#pragma once
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/rng.h"
#include "base/vec.h"
#include "collection/level.h"

namespace wellspring::test {

inline Collection make_mixture(int count, uint64_t seed = 2) {
  constexpr int properties = 8, groups = 8, parts = 4;
  Rng random(seed);
  auto normal = [&] {
    double sum = -6;
    for (int i = 0; i < 12; i++) sum += double(random.uniform());
    return sum;
  };
  auto draw = [&](double size) {
    std::vector<double> one;
    for (int i = 0; i < properties; i++) one.push_back(size * normal());
    return one;
  };
  struct Part {
    std::vector<double> middle, along, across;
  };
  std::vector<Part> all;
  for (int g = 0; g < groups; g++) {
    const auto middle = draw(1);
    const std::vector<double> ways[] = {draw(0.25), draw(0.25), draw(0.25)};
    for (int p = 0; p < parts; p++) {
      Part part{middle, draw(0.06), draw(0.06)};
      for (const auto& way : ways) {
        const double far = normal();
        for (size_t k = 0; k < properties; k++) part.middle[k] += far * way[k];
      }
      all.push_back(std::move(part));
    }
  }
  std::vector<SetItem> items;
  Collection made;
  for (int i = 0; i < count; i++) {
    const Part& part = all[random.next() % all.size()];
    const double along = normal(), across = normal();
    const int points = 2 + int(random.next() % 4);
    const auto own = draw(0.012);
    SetItem item;
    for (int j = 0; j < points; j++) {
      const auto noise = draw(0.02);
      for (size_t k = 0; k < properties; k++)
        item.points.push_back(part.middle[k] + along * part.along[k] + across * part.across[k] +
                              own[k] + noise[k]);
      item.masses.push_back(1);
    }
    items.push_back(std::move(item));
    made.records.all.emplace_back().id = std::to_string(i);
  }
  made.sets = Sets(items, properties);
  return made;
}

// Returns a circle of a part of the map's width around the object with the most neighbours.
inline MapStep circle_where_most_are(const MapLevel& level, double part) {
  double wide = 0;
  for (const dvec2& place : level.layout.places) wide = std::max(wide, glm::length(place));
  size_t pivot = 0, most = 0;
  for (size_t i = 0; i < level.shown.size(); i++) {
    const auto near = size_t(std::ranges::count_if(level.layout.places, [&](const dvec2& place) {
      return glm::distance(place, level.layout.places[i]) < part / 2 * wide;
    }));
    if (near > most) most = near, pivot = i;
  }
  return {level.shown[pivot], part * wide, {}};
}

}  // namespace wellspring::test
