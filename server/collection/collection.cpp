// SPDX-License-Identifier: Apache-2.0
#include "collection/collection.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "collection/eigenpairs.h"

namespace wellspring::collection {

namespace {

constexpr int year_at = 0, color_at = 1, term_at = 4, properties = term_at + term_numbers;
constexpr int most_term_products = 40;
constexpr double far_out = 3;  // quartile ranges beyond the quartiles (Tukey 1977)

// Counts which terms records have, each divided by the roots of both counts.
struct Incidence {
  std::vector<double> record_root, term_root;  // 1 / sqrt(count + an average count)
  std::vector<double> record_count, term_count;
  double all = 0;
};

Incidence count_terms(const Records& records) {
  Incidence found;
  found.term_count.resize(records.terms.size());
  for (const Record& record : records.all) {
    found.record_count.push_back(double(record.terms.size()));
    found.all += double(record.terms.size());
    for (const uint32_t term : record.terms) found.term_count[term]++;
  }
  const double record_mean = found.all / double(std::max<size_t>(records.all.size(), 1));
  const double term_mean = found.all / double(std::max<size_t>(records.terms.size(), 1));
  for (const double count : found.record_count)
    found.record_root.push_back(1 / std::sqrt(count + record_mean));
  for (const double count : found.term_count)
    found.term_root.push_back(1 / std::sqrt(count + term_mean));
  return found;
}

// Holds the years between which others keep their distances.
struct YearFences {
  double low = -INFINITY, high = INFINITY;
  double within(double year) const { return std::clamp(year, low, high); }
};

YearFences find_fences(const std::vector<Record>& records) {
  std::vector<double> years;
  for (const Record& record : records)
    if (record.year) years.push_back(*record.year);
  if (years.empty()) return {};
  std::ranges::sort(years);
  const double low = years[years.size() / 4], high = years[years.size() * 3 / 4];
  const double far = far_out * (high - low);
  return far > 0 ? YearFences{low - far, high + far} : YearFences{};
}

dvec3 mean_color(const std::vector<Swatch>& palette) {
  dvec3 sum(0);
  double weight = 0;
  for (const Swatch& one : palette) sum += one.weight * one.lab, weight += one.weight;
  return sum / weight;
}

}  // namespace

std::vector<double> place_terms(const Records& records) {
  const size_t n = records.terms.size(), wide = product_vectors;
  std::vector<double> places(n * term_numbers);
  const Incidence counts = count_terms(records);
  if (counts.all == 0) return places;
  // M^T M of M = R (A - r c^T / all) C: how far terms are together more often than by chance.
  auto product = [&](const double* vectors, double* products) {
    double expected[product_vectors] = {}, record_part[product_vectors] = {};
    for (size_t t = 0; t < n; t++)
      for (size_t k = 0; k < wide; k++)
        expected[k] += counts.term_count[t] * counts.term_root[t] * vectors[t * wide + k];
    std::fill(products, products + n * wide, 0.0);
    for (size_t i = 0; i < records.all.size(); i++) {
      double sums[product_vectors] = {};
      for (const uint32_t t : records.all[i].terms)
        for (size_t k = 0; k < wide; k++) sums[k] += counts.term_root[t] * vectors[t * wide + k];
      const double root = counts.record_root[i] * counts.record_root[i];
      for (size_t k = 0; k < wide; k++) {
        sums[k] = root * (sums[k] - counts.record_count[i] * expected[k] / counts.all);
        record_part[k] += counts.record_count[i] * sums[k];
      }
      for (const uint32_t t : records.all[i].terms)
        for (size_t k = 0; k < wide; k++) products[t * wide + k] += sums[k];
    }
    for (size_t t = 0; t < n; t++)
      for (size_t k = 0; k < wide; k++)
        products[t * wide + k] =
            counts.term_root[t] *
            (products[t * wide + k] - counts.term_count[t] * record_part[k] / counts.all);
  };
  const auto pairs = top_eigenpairs(int(n), term_numbers, product, most_term_products);
  for (size_t k = 0; k < pairs.size(); k++) {
    // Values that are no more than rounding have no direction.
    if (!(pairs[k].value > 1e-9)) continue;
    for (size_t t = 0; t < n; t++)
      places[t * term_numbers + k] =
          counts.term_root[t] * pairs[k].vector[t] * std::sqrt(pairs[k].value);
  }
  return places;
}

Collection make_collection(Records records) {
  const std::vector<double> places = place_terms(records);
  double year = 0, dated = 0;
  dvec3 color(0);
  double colored = 0;
  const YearFences fences = find_fences(records.all);
  for (const Record& record : records.all) {
    if (record.year) year += fences.within(*record.year), dated++;
    if (!record.palette.empty()) color += mean_color(record.palette), colored++;
  }
  year = dated > 0 ? year / dated : 0;
  color = colored > 0 ? color / colored : color;
  std::vector<SetItem> items;
  items.reserve(records.all.size());
  for (const Record& record : records.all) {
    SetItem item;
    double base[properties] = {};
    base[year_at] = record.year ? fences.within(*record.year) : year;
    const dvec3 mean = record.palette.empty() ? color : mean_color(record.palette);
    for (int k = 0; k < 3; k++) base[color_at + k] = mean[k];
    for (const uint32_t term : record.terms)
      for (size_t k = 0; k < term_numbers; k++)
        base[term_at + k] += places[term * term_numbers + k] / double(record.terms.size());
    auto add = [&](const double* point, double mass) {
      item.points.insert(item.points.end(), point, point + properties);
      item.masses.push_back(mass);
    };
    for (const uint32_t term : record.terms) {
      double point[properties];
      std::copy(base, base + properties, point);
      std::copy_n(places.begin() + std::ptrdiff_t(term * term_numbers), term_numbers,
                  point + term_at);
      add(point, 1 / double(record.terms.size()));
    }
    double weight = 0;
    for (const Swatch& swatch : record.palette) weight += swatch.weight;
    for (const Swatch& swatch : record.palette) {
      double point[properties];
      std::copy(base, base + properties, point);
      for (int k = 0; k < 3; k++) point[color_at + k] = swatch.lab[k];
      add(point, swatch.weight / weight);
    }
    if (item.masses.empty()) add(base, 1);
    items.push_back(std::move(item));
  }
  Collection made;
  made.sets = Sets(items, properties);
  made.records = std::move(records);
  return made;
}

}  // namespace wellspring::collection
