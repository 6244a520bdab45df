// SPDX-License-Identifier: Apache-2.0
#include "spectrum/spectrum.h"

#include <algorithm>
#include <cmath>

namespace wellspring::spectrum {
namespace {

// Knows the integral of a table from its first wavelength on.
class TableIntegral {
 public:
  explicit TableIntegral(const SpectrumTable& table) : table_(table), until_(table.nm.size(), 0) {
    for (size_t i = 1; i < until_.size(); i++)
      until_[i] = until_[i - 1] +
                  0.5 * (table.value[i] + table.value[i - 1]) * (table.nm[i] - table.nm[i - 1]);
  }
  double until(double nm) const {
    if (nm <= table_.nm.front()) return (nm - table_.nm.front()) * table_.value.front();
    if (nm >= table_.nm.back())
      return until_.back() + (nm - table_.nm.back()) * table_.value.back();
    const size_t i = size_t(std::ranges::upper_bound(table_.nm, nm) - table_.nm.begin()) - 1;
    return until_[i] + 0.5 * (table_.value[i] + value_at(table_, nm)) * (nm - table_.nm[i]);
  }

 private:
  const SpectrumTable& table_;
  std::vector<double> until_;
};

// Returns the values with two more before and behind, which CIE 167 extrapolates.
std::vector<double> extend_ends(const std::vector<double>& y) {
  static constexpr double first[6] = {884, -1960, 3033, -2648, 1080, -180};
  static constexpr double second[6] = {508, -540, 488, -367, 144, -24};
  std::vector<double> all(y.size() + 4, 0.0);
  std::ranges::copy(y, all.begin() + 2);
  for (size_t k = 0; k < 6; k++) {
    all[0] += first[k] * y[k] / 209, all[1] += second[k] * y[k] / 209;
    all[y.size() + 3] += first[k] * y[y.size() - 1 - k] / 209;
    all[y.size() + 2] += second[k] * y[y.size() - 1 - k] / 209;
  }
  return all;
}

// Returns the value at x in [0, 1] between r[2] and r[3].
double sprague(const double* r, double x) {
  const double a[6] = {
      r[2],
      (2 * r[0] - 16 * r[1] + 16 * r[3] - 2 * r[4]) / 24,
      (-r[0] + 16 * r[1] - 30 * r[2] + 16 * r[3] - r[4]) / 24,
      (-9 * r[0] + 39 * r[1] - 70 * r[2] + 66 * r[3] - 33 * r[4] + 7 * r[5]) / 24,
      (13 * r[0] - 64 * r[1] + 126 * r[2] - 124 * r[3] + 61 * r[4] - 12 * r[5]) / 24,
      (-5 * r[0] + 25 * r[1] - 50 * r[2] + 50 * r[3] - 25 * r[4] + 5 * r[5]) / 24};
  double sum = 0;
  for (int k = 5; k >= 0; k--) sum = sum * x + a[k];
  return sum;
}

}  // namespace

Spectrum even_spectrum(double value) {
  Spectrum spectrum;
  spectrum.fill(value);
  return spectrum;
}

double value_at(const SpectrumTable& table, double nm) {
  if (nm <= table.nm.front()) return table.value.front();
  if (nm >= table.nm.back()) return table.value.back();
  const size_t i = size_t(std::ranges::upper_bound(table.nm, nm) - table.nm.begin());
  const double t = (nm - table.nm[i - 1]) / (table.nm[i] - table.nm[i - 1]);
  return table.value[i - 1] + t * (table.value[i] - table.value[i - 1]);
}

Spectrum resample(const SpectrumTable& table) {
  const TableIntegral integral(table);
  Spectrum spectrum;
  double before = integral.until(nm_of(0) - 0.5);
  for (size_t i = 0; i < spectrum_size; i++) {
    const double here = integral.until(nm_of(i) + 0.5);
    spectrum[i] = here - before;
    before = here;
  }
  return spectrum;
}

Spectrum interpolate_sprague(const SpectrumTable& table) {
  const std::vector<double> values = extend_ends(table.value);
  const double step = table.nm[1] - table.nm[0];
  const size_t last = table.nm.size() - 2;
  Spectrum spectrum;
  for (size_t i = 0; i < spectrum_size; i++) {
    const double at = (nm_of(i) - table.nm.front()) / step;
    const size_t k = size_t(std::clamp(std::floor(at), 0.0, double(last)));
    spectrum[i] = sprague(&values[k], std::clamp(at - double(k), 0.0, 1.0));
  }
  return spectrum;
}

void add_line(double nm, double power, Spectrum& spectrum) {
  const double at = nm - double(first_nm);
  if (!(at >= 0 && at <= double(spectrum_size - 1))) return;
  const size_t i = std::min(size_t(at), spectrum_size - 2);
  spectrum[i] += power * (double(i) + 1 - at);
  spectrum[i + 1] += power * (at - double(i));
}

Spectrum product(const Spectrum& a, const Spectrum& b) {
  Spectrum spectrum;
  for (size_t i = 0; i < spectrum_size; i++) spectrum[i] = a[i] * b[i];
  return spectrum;
}

}  // namespace wellspring::spectrum
