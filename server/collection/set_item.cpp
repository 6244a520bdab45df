// SPDX-License-Identifier: Apache-2.0
#include "collection/set_item.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "collection/eigenpairs.h"

namespace wellspring::collection {

namespace {

constexpr double mass_unit = 0x1p-50;
constexpr double no_spread = 1e-9;  // an eigenvalue of correlations that is no more than rounding

// Makes masses whole multiples of the unit that sum to 1.
void settle_masses(std::span<double> masses) {
  double sum = 0;
  for (const double mass : masses) sum += mass;
  double left = 1;
  for (double& mass : masses) {
    mass = std::max(std::round(mass / sum / mass_unit), 1.0) * mass_unit;
    left -= mass;
  }
  *std::ranges::max_element(masses) += left;
}

double square_distance(const double* a, const double* b, int count) {
  double sum = 0;
  for (int i = 0; i < count; i++) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

}  // namespace

std::vector<double> whitening_rows(std::span<const double> points, int properties) {
  const size_t p = size_t(properties), count = points.size() / p;
  std::vector<double> mean(p), spread(p), correlation(p * p);
  for (size_t i = 0; i < points.size(); i++) mean[i % p] += points[i] / double(count);
  for (size_t i = 0; i < points.size(); i++) {
    const double off = points[i] - mean[i % p];
    spread[i % p] += off * off / double(count);
  }
  for (size_t i = 0; i < p; i++) {
    // Rounding of the mean is no spread.
    spread[i] = std::sqrt(spread[i]);
    if (spread[i] <= 1e-12 * std::abs(mean[i])) spread[i] = 0;
  }
  for (size_t i = 0; i < points.size(); i += p)
    for (size_t a = 0; a < p; a++)
      for (size_t b = 0; b <= a; b++)
        if (spread[a] > 0 && spread[b] > 0)
          correlation[a * p + b] += (points[i + a] - mean[a]) / spread[a] *
                                    (points[i + b] - mean[b]) / spread[b] / double(count);
  for (size_t a = 0; a < p; a++)
    for (size_t b = a + 1; b < p; b++) correlation[a * p + b] = correlation[b * p + a];
  std::vector<double> rows;
  for (const EigenPair& pair : small_eigenpairs(std::move(correlation), properties)) {
    if (pair.value <= no_spread) continue;
    for (size_t a = 0; a < p; a++)
      rows.push_back(spread[a] > 0 ? pair.vector[a] / spread[a] / std::sqrt(pair.value) : 0);
  }
  return rows;
}

void merge_nearest(SetItem& item, int properties, int most) {
  const size_t p = size_t(properties);
  while (item.masses.size() > size_t(most)) {
    size_t first = 0, second = 1;
    double best = INFINITY;
    for (size_t i = 0; i < item.masses.size(); i++)
      for (size_t k = i + 1; k < item.masses.size(); k++) {
        // Ward's cost: light points that are near go first.
        const double weight = item.masses[i] * item.masses[k] / (item.masses[i] + item.masses[k]);
        const double cost =
            weight * square_distance(&item.points[i * p], &item.points[k * p], properties);
        if (cost < best) best = cost, first = i, second = k;
      }
    const double sum = item.masses[first] + item.masses[second];
    const double part = item.masses[second] / sum;
    for (size_t a = 0; a < p; a++) {
      double& to = item.points[first * p + a];
      to += part * (item.points[second * p + a] - to);
    }
    item.masses[first] = sum;
    item.masses.erase(item.masses.begin() + std::ptrdiff_t(second));
    const auto at = item.points.begin() + std::ptrdiff_t(second * p);
    item.points.erase(at, at + properties);
  }
}

Sets::Sets(std::span<const SetItem> items, int properties) {
  const size_t p = size_t(properties);
  std::vector<double> points;
  for (const SetItem& item : items)
    points.insert(points.end(), item.points.begin(), item.points.end());
  const std::vector<double> whiten = whitening_rows(points, properties);
  std::vector<double> middle(p);
  for (size_t i = 0; i < points.size(); i++) middle[i % p] += points[i];
  for (double& one : middle) one /= double(std::max<size_t>(points.size() / p, 1));
  dims_ = int(whiten.size() / p);
  for (const SetItem& item : items) {
    SetItem white{{}, item.masses};
    for (size_t i = 0; i < item.points.size(); i += p)
      for (size_t d = 0; d < size_t(dims_); d++) {
        double sum = 0;
        for (size_t a = 0; a < p; a++) sum += whiten[d * p + a] * (item.points[i + a] - middle[a]);
        white.points.push_back(sum);
      }
    if (dims_ == 0) white.masses = {1};
    merge_nearest(white, dims_, most_points);
    settle_masses(white.masses);
    const size_t count = white.masses.size(), stride = (count + 3) / 4 * 4;
    begin_.push_back(
        {uint32_t(rows_.size()), uint32_t(masses_.size()), uint16_t(count), uint16_t(stride)});
    std::vector<double> mean(size_t(dims_), 0.0);
    for (size_t d = 0; d < size_t(dims_); d++)
      for (size_t i = 0; i < stride; i++) {
        const float at = i < count ? float(white.points[i * size_t(dims_) + d]) : 0;
        rows_.push_back(at);
        if (i < count) mean[d] += white.masses[i] * double(at);
      }
    means_.insert(means_.end(), mean.begin(), mean.end());
    masses_.insert(masses_.end(), white.masses.begin(), white.masses.end());
  }
}

SetView Sets::operator[](int i) const {
  const Begin& begin = begin_[size_t(i)];
  return {rows_.data() + begin.rows, masses_.data() + begin.masses,
          means_.data() + size_t(i) * size_t(dims_), begin.count, begin.stride};
}

}  // namespace wellspring::collection
