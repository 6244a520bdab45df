// SPDX-License-Identifier: Apache-2.0
#include "collection/level.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/rng.h"

namespace wellspring::collection {

namespace {

constexpr size_t told_terms = 3;

// Draws so many of the region, `first` among them if it is there.
std::vector<int> draw_shown(const std::vector<int>& region, int most, int first, uint64_t seed) {
  std::vector<int> shown(region);
  Rng random(seed ^ mix64(region.size()));
  const size_t count = std::min(shown.size(), size_t(std::max(most, 1)));
  if (const auto at = std::ranges::find(shown, first); at != shown.end())
    std::iter_swap(shown.begin(), at);
  const size_t fixed = first >= 0 && !shown.empty() && shown[0] == first;
  for (size_t i = fixed; i < count && count < shown.size(); i++)
    std::swap(shown[i], shown[i + random.next() % (shown.size() - i)]);
  shown.resize(count);
  std::ranges::sort(shown);
  return shown;
}

std::vector<ClusterNature> describe(const Collection& collection, const MapLevel& level) {
  const size_t clusters = level.clusters.medoids.size();
  std::vector<ClusterNature> natures(clusters);
  std::vector<std::vector<double>> years(clusters);
  std::vector<std::vector<int>> counts(clusters, std::vector<int>(collection.records.terms.size()));
  std::vector<int> all(collection.records.terms.size());
  for (size_t i = 0; i < level.shown.size(); i++) {
    const Record& record = collection.records.all[size_t(level.shown[i])];
    const size_t cluster = size_t(level.clusters.of[i]);
    natures[cluster].count++;
    if (record.year) years[cluster].push_back(*record.year);
    for (const uint32_t term : record.terms) counts[cluster][term]++, all[term]++;
  }
  for (size_t k = 0; k < clusters; k++) {
    std::vector<std::pair<double, uint32_t>> telling;
    for (uint32_t term = 0; term < all.size(); term++) {
      if (counts[k][term] == 0) continue;
      const double here = counts[k][term] / double(natures[k].count);
      const double others = all[term] - counts[k][term];
      const double rest = double(level.shown.size()) - natures[k].count;
      telling.emplace_back(rest > 0 ? others / rest - here : -here, term);
    }
    std::ranges::sort(telling);
    for (size_t i = 0; i < std::min(telling.size(), told_terms); i++)
      if (telling[i].first < 0) natures[k].terms.push_back(telling[i].second);
    if (years[k].empty()) continue;
    std::ranges::sort(years[k]);
    const size_t tenth = years[k].size() / 10;
    natures[k].first = int(std::lround(years[k][tenth]));
    natures[k].last = int(std::lround(years[k][years[k].size() - 1 - tenth]));
  }
  return natures;
}

void draw_level(const Collection& collection, MapLevel& level, int first, const MapChoice& choice) {
  level.shown =
      draw_shown(level.region, std::min(choice.most_shown, most_on_map), first, choice.seed);
  level.distances = find_distances(collection.sets, level.shown);
  level.layout = lay_out(level.distances);
  level.clusters = find_clusters(
      int(level.shown.size()), choice.most_clusters,
      [&](int i, int k) { return level.distances.at(i, k); }, choice.seed);
  level.natures = describe(collection, level);
}

template <class Number>
bool read_number(std::string_view& text, Number& to) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), to);
  if (error != std::errc()) return false;
  text.remove_prefix(size_t(end - text.data()));
  return true;
}

}  // namespace

MapLevel make_first_level(const Collection& collection, const MapChoice& choice) {
  MapLevel level;
  level.region.resize(collection.records.all.size());
  std::iota(level.region.begin(), level.region.end(), 0);
  level.among = level.region;
  draw_level(collection, level, -1, choice);
  return level;
}

std::optional<MapLevel> take_step(const Collection& collection, const MapLevel& level,
                                  const MapStep& step, const MapChoice& choice) {
  MapLevel next;
  if (step.pivot >= 0) {
    const auto at = std::ranges::lower_bound(level.shown, step.pivot);
    if (at == level.shown.end() || *at != step.pivot) return {};
    if (!(step.radius >= 0 && step.radius < 1e9)) return {};
    const CircleMeaning meaning = read_circle(
        level.layout, level.distances, int(at - level.shown.begin()), step.radius, choice.circle);
    next.among = level.among;
    next.ball = meaning.ball;
    next.outliers = int(meaning.outliers.size());
    next.region = select_ball(collection.sets, next.among, step.pivot, meaning.ball);
  } else {
    std::vector<bool> chosen(level.clusters.medoids.size());
    for (const int one : step.clusters) {
      if (one < 0 || size_t(one) >= chosen.size()) return {};
      chosen[size_t(one)] = true;
    }
    std::vector<int> medoids;
    for (const int one : level.clusters.medoids) medoids.push_back(level.shown[size_t(one)]);
    const std::vector<int> nearest = nearest_medoids(collection.sets, level.region, medoids);
    for (size_t i = 0; i < level.region.size(); i++)
      if (chosen[size_t(nearest[i])]) next.region.push_back(level.region[i]);
    if (next.region.empty()) return {};
    next.among = next.region;
  }
  draw_level(collection, next, step.pivot, choice);
  return next;
}

std::optional<std::vector<MapStep>> read_trail(std::string_view text) {
  std::vector<MapStep> steps;
  while (!text.empty()) {
    MapStep step;
    if (steps.size() >= most_steps) return {};
    if (text.starts_with('c')) {
      do {
        text.remove_prefix(1);
        int cluster = -1;
        if (!read_number(text, cluster) || cluster < 0 || step.clusters.size() >= 64) return {};
        step.clusters.push_back(cluster);
      } while (text.starts_with(','));
    } else {
      if (!read_number(text, step.pivot) || step.pivot < 0 || !text.starts_with('@')) return {};
      text.remove_prefix(1);
      if (!read_number(text, step.radius) || !(step.radius >= 0)) return {};
    }
    steps.push_back(std::move(step));
    if (text.empty()) break;
    if (!text.starts_with(';') || text.size() == 1) return {};
    text.remove_prefix(1);
  }
  return steps;
}

}  // namespace wellspring::collection
