// SPDX-License-Identifier: Apache-2.0
#include "volume/compare/statistics.h"

#include <algorithm>
#include <cmath>

namespace wellspring::volume {

namespace {
constexpr size_t summary_bins = 64;
}

DeviationSummary summarize(const std::vector<SurfacePoint>& points,
                           const std::vector<Deviation>& deviations) {
  DeviationSummary summary;
  summary.points = points.size();
  summary.histogram.assign(summary_bins, 0);
  double all_area = 0, area = 0, squares = 0;
  std::vector<std::pair<double, double>> weighted;  // distance, area
  for (size_t i = 0; i < points.size(); i++) {
    const Deviation& one = deviations[i];
    const double weight = points[i].area;
    all_area += weight;
    if (!one.found) continue;
    const double distance = one.distance;
    if (summary.found == 0) summary.least = summary.greatest = distance;
    summary.found++;
    summary.least = std::min(summary.least, distance);
    summary.greatest = std::max(summary.greatest, distance);
    summary.greatest_uncertainty = std::max(summary.greatest_uncertainty, double(one.uncertainty));
    if (!(weight > 0)) continue;
    area += weight;
    summary.mean += weight * distance;
    summary.mean_absolute += weight * std::abs(distance);
    squares += weight * distance * distance;
    summary.mean_uncertainty += weight * one.uncertainty;
    summary.mean_normal_angle += weight * one.normal_angle;
    weighted.push_back({distance, weight});
  }
  if (all_area > 0) summary.not_found_share = std::clamp(1 - area / all_area, 0.0, 1.0);
  if (!(area > 0)) return summary;
  for (double* sum : {&summary.mean, &summary.mean_absolute, &summary.mean_uncertainty,
                      &summary.mean_normal_angle})
    *sum /= area;
  summary.root_mean_square = std::sqrt(squares / area);
  summary.deviation = std::sqrt(std::max(0.0, squares / area - summary.mean * summary.mean));
  std::sort(weighted.begin(), weighted.end());
  double below = 0;
  size_t at = 0;
  for (double percent : {1.0, 5.0, 25.0, 50.0, 75.0, 95.0, 99.0}) {
    while (at + 1 < weighted.size() && below + weighted[at].second < area * percent / 100)
      below += weighted[at++].second;
    summary.percentiles.push_back({percent, weighted[at].first});
  }
  const double width = summary.greatest - summary.least;
  for (const auto& [distance, weight] : weighted) {
    const double place = width > 0 ? (distance - summary.least) / width : 0;
    summary.histogram[std::min(size_t(place * summary_bins), summary_bins - 1)] += weight / area;
  }
  return summary;
}

}  // namespace wellspring::volume
