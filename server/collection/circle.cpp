// SPDX-License-Identifier: Apache-2.0
#include "collection/circle.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "collection/earth_mover.h"

namespace wellspring::collection {

CircleMeaning read_circle(const Layout& layout, const Distances& distances, int pivot,
                          double radius, const CircleChoice& choice) {
  CircleMeaning meaning;
  const dvec2 middle = layout.places[size_t(pivot)];
  for (int i = 0; i < distances.count; i++)
    if (i == pivot || glm::distance(layout.places[size_t(i)], middle) <= radius)
      meaning.inside.push_back(i);
  for (const int i : meaning.inside) {
    double shown = 0, truth = 0;
    for (const int k : meaning.inside) {
      shown += glm::distance(layout.places[size_t(i)], layout.places[size_t(k)]);
      truth += distances.at(i, k);
    }
    meaning.local_stress.push_back(truth > 0 ? shown / truth : 1);
  }
  const double count = double(meaning.inside.size());
  for (const double one : meaning.local_stress) meaning.mean += one / count;
  for (const double one : meaning.local_stress)
    meaning.deviation += (one - meaning.mean) * (one - meaning.mean) / count;
  meaning.deviation = std::sqrt(meaning.deviation);
  // A map that is true everywhere has outliers by rounding alone.
  const double least = meaning.mean - choice.alpha * meaning.deviation - 1e-9;
  std::vector<double> far;
  for (size_t i = 0; i < meaning.inside.size(); i++) {
    const int item = meaning.inside[i];
    if (item != pivot && meaning.local_stress[i] < least) meaning.outliers.push_back(item);
    else far.push_back(distances.at(item, pivot));
  }
  std::ranges::sort(far);
  const double rank = std::ceil(std::clamp(choice.lambda, 0.0, 1.0) * double(far.size()));
  meaning.ball = far[size_t(std::max(rank, 1.0)) - 1];
  return meaning;
}

std::vector<int> select_ball(const Sets& sets, std::span<const int> among, int pivot, double ball,
                             BallCost* cost) {
  std::vector<uint8_t> inside(among.size());
  std::atomic<int> computed{0};
  const SetView middle = sets[pivot];
  parallel_ranges(int(among.size()), 256, [&](int begin, int end) {
    int here = 0;
    for (int i = begin; i < end; i++) {
      const SetView item = sets[among[size_t(i)]];
      if (mean_distance(middle, item, sets.dims()) > ball + 1e-9 * (1 + ball)) continue;
      here++;
      inside[size_t(i)] = earth_mover(middle, item, sets.dims(), ball) <= ball;
    }
    computed += here;
  });
  std::vector<int> found;
  for (size_t i = 0; i < among.size(); i++)
    if (inside[i]) found.push_back(among[i]);
  if (cost) *cost = {int(among.size()), computed.load()};
  return found;
}

}  // namespace wellspring::collection
