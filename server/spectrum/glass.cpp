// SPDX-License-Identifier: Apache-2.0
#include "spectrum/glass.h"

#include <algorithm>
#include <cmath>

namespace wellspring::spectrum {
namespace {

// Reads coefficients that a file may leave out at the end: they are 0.
struct Coefficients {
  const std::vector<double>& all;
  double operator[](size_t i) const { return i < all.size() ? all[i] : 0; }
  size_t size() const { return all.size(); }
};

double square(double x) { return x * x; }

// Returns sum c_i l^2 / (l^2 - pole).
double sellmeier(const Coefficients& c, double l2, bool are_poles_squared) {
  double sum = c[0];
  for (size_t i = 1; i < c.size(); i += 2) {
    const double pole = are_poles_squared ? square(c[i + 1]) : c[i + 1];
    sum += c[i] * l2 / (l2 - pole);
  }
  return sum;
}

// Returns sum c_i l^c_{i+1} from the i-th coefficient on.
double powers(const Coefficients& c, double l, size_t from) {
  double sum = 0;
  for (size_t i = from; i < c.size(); i += 2) sum += c[i] * std::pow(l, c[i + 1]);
  return sum;
}

double peaks_and_powers(const Coefficients& c, double l) {
  double sum = c[0] + powers(c, l, 9);
  for (size_t i = 1; i < std::min<size_t>(9, c.size()); i += 4)
    if (c[i] != 0)  // a peak that is not used may have any place
      sum += c[i] * std::pow(l, c[i + 1]) / (square(l) - std::pow(c[i + 2], c[i + 3]));
  return sum;
}

double gas(const Coefficients& c, double l2) {
  double sum = c[0];
  for (size_t i = 1; i < c.size(); i += 2) sum += c[i] / (c[i + 1] - 1 / l2);
  return sum;
}

double herzberger(const Coefficients& c, double l2) {
  const double l = 1 / (l2 - 0.028);
  return c[0] + l * (c[1] + l * c[2]) + l2 * (c[3] + l2 * (c[4] + l2 * c[5]));
}

double retro(const Coefficients& c, double l2) {
  const double share = c[0] + c[1] * l2 / (l2 - c[2]) + c[3] * l2;  // (n^2 - 1) / (n^2 + 2)
  return std::sqrt((1 + 2 * share) / (1 - share));
}

double exotic(const Coefficients& c, double l) {
  const double off = l - c[4];
  return std::sqrt(c[0] + c[1] / (square(l) - c[2]) + c[3] * off / (square(off) + c[5]));
}

double by_formula(int formula, const Coefficients& c, double l) {
  const double l2 = square(l);
  switch (formula) {
    case 1: return std::sqrt(1 + sellmeier(c, l2, true));
    case 2: return std::sqrt(1 + sellmeier(c, l2, false));
    case 3: return std::sqrt(c[0] + powers(c, l, 1));
    case 4: return std::sqrt(peaks_and_powers(c, l));
    case 5: return c[0] + powers(c, l, 1);  // Cauchy
    case 6: return 1 + gas(c, l2);
    case 7: return herzberger(c, l2);
    case 8: return retro(c, l2);
    case 9: return exotic(c, l);
  }
  return NAN;
}

}  // namespace

std::optional<double> index_at(const Dispersion& glass, double nm) {
  if (!(nm >= glass.low_nm && nm <= glass.high_nm)) return {};
  const double index = glass.formula == 0
                           ? value_at(glass.index, nm)
                           : by_formula(glass.formula, {glass.coefficients}, nm / 1000);
  return std::isfinite(index) && index > 0 ? std::optional(index) : std::nullopt;
}

std::optional<double> abbe_number(const Dispersion& glass) {
  const auto f = index_at(glass, line_F_nm), d = index_at(glass, line_d_nm),
             c = index_at(glass, line_C_nm);
  if (!f || !d || !c || *f == *c) return {};
  return (*d - 1) / (*f - *c);
}

std::optional<double> transmittance_at(const Dispersion& glass, double nm, double metres) {
  const std::vector<double>& known = glass.extinction.nm;
  if (known.empty() || nm < known.front() || nm > known.back()) return {};
  constexpr double four_pi = 12.566370614359172;
  return std::exp(-four_pi * value_at(glass.extinction, nm) * metres / (nm * 1e-9));
}

}  // namespace wellspring::spectrum
