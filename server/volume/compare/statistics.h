// SPDX-License-Identifier: Apache-2.0
// Sums up deviations in numbers.
#pragma once
#include <vector>

#include "volume/compare/cone_search.h"

namespace wellspring::volume {

// All distances are signed and in metres. Means, shares and percentiles count each point by its
// area; the least and the greatest count all points.
struct DeviationSummary {
  size_t points = 0, found = 0;
  double not_found_share = 0;  // a share of the area
  double least = 0, greatest = 0, mean = 0, mean_absolute = 0, root_mean_square = 0, deviation = 0;
  double mean_uncertainty = 0, greatest_uncertainty = 0;
  double mean_normal_angle = 0;  // radians
  struct Percentile {
    double percent = 0, distance = 0;
  };
  std::vector<Percentile> percentiles;  // 1, 5, 25, 50, 75, 95, 99
  std::vector<double> histogram;        // shares of the found area, evenly from least to greatest
};

DeviationSummary summarize(const std::vector<SurfacePoint>& points,
                           const std::vector<Deviation>& deviations);

}  // namespace wellspring::volume
