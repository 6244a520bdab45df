// SPDX-License-Identifier: Apache-2.0
#include "collection/clusters.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/parallel.h"
#include "base/rng.h"
#include "collection/earth_mover.h"

namespace wellspring::collection {

namespace {

// Holds the distances of a sample, and which of it are medoids.
struct Sample {
  std::vector<int> items;
  std::vector<double> all;
  double at(size_t i, size_t k) const { return all[i * items.size() + k]; }
};

double cost_of(const Sample& sample, const std::vector<size_t>& medoids) {
  double sum = 0;
  for (size_t i = 0; i < sample.items.size(); i++) {
    double least = INFINITY;
    for (const size_t medoid : medoids) least = std::min(least, sample.at(i, medoid));
    sum += least;
  }
  return sum;
}

// Partitions around medoids: takes one after the other that saves most, then exchanges while that
// saves something.
std::vector<size_t> partition(const Sample& sample, size_t most) {
  std::vector<size_t> medoids;
  double cost = INFINITY;
  while (medoids.size() < std::min(most, sample.items.size())) {
    size_t best = 0;
    double least = cost;
    for (size_t i = 0; i < sample.items.size(); i++) {
      medoids.push_back(i);
      if (const double now = cost_of(sample, medoids); now < least) least = now, best = i;
      medoids.pop_back();
    }
    if (!(least < cost)) break;
    medoids.push_back(best);
    cost = least;
  }
  for (bool better = true; better && cost > 0;) {
    better = false;
    std::pair<size_t, size_t> change;
    double least = cost * (1 - 1e-12);
    for (size_t slot = 0; slot < medoids.size(); slot++)
      for (size_t i = 0; i < sample.items.size(); i++) {
        const size_t before = std::exchange(medoids[slot], i);
        if (const double now = cost_of(sample, medoids); now < least)
          least = now, change = {slot, i}, better = true;
        medoids[slot] = before;
      }
    if (better) medoids[change.first] = change.second, cost = least;
  }
  return medoids;
}

// Draws `size` different items, those of `kept` among them.
std::vector<int> draw(int count, size_t size, const std::vector<int>& kept, Rng& random) {
  std::vector<int> items(kept);
  std::vector<bool> taken(size_t(count), false);
  for (const int one : kept) taken[size_t(one)] = true;
  while (items.size() < std::min(size, size_t(count))) {
    const int one = int(random.next() % uint32_t(count));
    if (!taken[size_t(one)]) items.push_back(one);
    taken[size_t(one)] = true;
  }
  return items;
}

}  // namespace

Clusters find_clusters(int count, int most, const std::function<double(int, int)>& distance,
                       uint64_t seed, int draws) {
  Clusters best;
  best.cost = INFINITY;
  if (count <= 0) return {};
  Rng random(seed);
  const size_t size = size_t(40 + 2 * most);
  for (int one = 0; one < draws; one++) {
    Sample sample{draw(count, size, best.medoids, random), {}};
    for (const int a : sample.items)
      for (const int b : sample.items) sample.all.push_back(a == b ? 0 : distance(a, b));
    Clusters now;
    for (const size_t medoid : partition(sample, size_t(most)))
      now.medoids.push_back(sample.items[medoid]);
    now.of.resize(size_t(count));
    std::vector<double> nearest(size_t(count), INFINITY);
    parallel_for(count, [&](int i) {
      for (size_t k = 0; k < now.medoids.size(); k++) {
        const double far = i == now.medoids[k] ? 0 : distance(i, now.medoids[k]);
        if (far < nearest[size_t(i)]) nearest[size_t(i)] = far, now.of[size_t(i)] = int(k);
      }
    });
    now.cost = std::accumulate(nearest.begin(), nearest.end(), 0.0);
    if (now.cost < best.cost) best = std::move(now);
    if (size >= size_t(count)) break;  // another draw would be the same
  }
  std::vector<int> sizes(best.medoids.size()), order(best.medoids.size()), rank(order.size());
  for (const int one : best.of) sizes[size_t(one)]++;
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order,
                           [&](int a, int b) { return sizes[size_t(a)] > sizes[size_t(b)]; });
  std::vector<int> medoids;
  for (size_t k = 0; k < order.size(); k++) {
    rank[size_t(order[k])] = int(k);
    medoids.push_back(best.medoids[size_t(order[k])]);
  }
  best.medoids = std::move(medoids);
  for (int& one : best.of) one = rank[size_t(one)];
  return best;
}

std::vector<int> nearest_medoids(const Sets& sets, std::span<const int> items,
                                 std::span<const int> medoids) {
  std::vector<int> found(items.size());
  parallel_for(int(items.size()), [&](int i) {
    const SetView item = sets[items[size_t(i)]];
    std::vector<std::pair<double, int>> bounds;
    for (size_t k = 0; k < medoids.size(); k++)
      bounds.emplace_back(mean_distance(item, sets[medoids[k]], sets.dims()), int(k));
    std::ranges::sort(bounds);  // the likely ones first
    double least = INFINITY;
    int best = 0;
    for (const auto& [bound, k] : bounds) {
      if (bound > least + 1e-9 * (1 + least)) break;
      const double far = earth_mover(item, sets[medoids[size_t(k)]], sets.dims(), least);
      if (far < least || (far == least && k < best)) least = far, best = k;
    }
    found[size_t(i)] = best;
  });
  return found;
}

}  // namespace wellspring::collection
