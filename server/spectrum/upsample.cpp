// SPDX-License-Identifier: Apache-2.0
#include "spectrum/upsample.h"

#include <algorithm>
#include <cmath>

#include "spectrum/color.h"
#include "spectrum/lamps.h"
#include "spectrum/observer.h"

namespace wellspring::spectrum {
namespace {

constexpr int most_steps = 60;
constexpr double good_enough = 1e-10;  // squared distance in Lab

double place_of(double nm) { return (nm - first_nm) / (last_nm - first_nm); }
double sigmoid(double x) { return 0.5 + 0.5 * x / std::sqrt(1 + x * x); }
double sigmoid_slope(double x) { return 0.5 / std::pow(1 + x * x, 1.5); }

const LampObserver& reference() {
  static const LampObserver made(find_lamp("D65")->power);
  return made;
}

// Looks at coefficients: how far their colour is from the wanted one, and how it changes.
struct Look {
  dvec3 error{0};  // in Lab
  glm::dmat3 change{0.0};
  double squared() const { return glm::dot(error, error); }
};

Look look_at(const dvec3& coefficients, const dvec3& wanted) {
  dvec3 xyz(0);
  glm::dmat3 slopes(0.0);  // a column is the change of X, Y, Z with one coefficient
  for (size_t i = 0; i < spectrum_size; i++) {
    const double x = place_of(nm_of(i));
    const dvec3 powers(x * x, x, 1);
    const double sum = glm::dot(coefficients, powers);
    const dvec3& weight = reference().weights()[i];
    xyz += sigmoid(sum) * weight;
    for (int k = 0; k < 3; k++) slopes[k] += sigmoid_slope(sum) * powers[k] * weight;
  }
  const dvec3 lab = lab_of(xyz, reference().white());
  Look look{lab - wanted, glm::dmat3(0.0)};
  constexpr double step = 1e-6;
  for (int k = 0; k < 3; k++)
    look.change[k] = (lab_of(xyz + step * slopes[k], reference().white()) - lab) / step;
  return look;
}

// Returns the damped step of Gauss and Newton (Levenberg and Marquardt).
dvec3 step_of(const Look& look, double damping) {
  glm::dmat3 normal = glm::transpose(look.change) * look.change;
  for (int k = 0; k < 3; k++) normal[k][k] += damping * normal[k][k] + 1e-12;
  return glm::inverse(normal) * (glm::transpose(look.change) * -look.error);
}

}  // namespace

double SmoothReflectance::at(double nm) const {
  const double x = place_of(nm);
  return sigmoid((coefficients.x * x + coefficients.y) * x + coefficients.z);
}

SmoothReflectance fit_reflectance(const dvec3& rgb) {
  // White is as bright as the lamp's own, whose rounding is not that of Rec. 709.
  const dvec3 xyz = xyz_of_rgb(glm::clamp(rgb, dvec3(0), dvec3(1))) / xyz_of_rgb(dvec3(1));
  const dvec3 wanted = lab_of(xyz, dvec3(1));
  SmoothReflectance found;
  Look here = look_at(found.coefficients, wanted);
  double damping = 1e-3;
  for (int i = 0; i < most_steps && here.squared() > good_enough && damping < 1e8; i++) {
    const dvec3 next = found.coefficients + step_of(here, damping);
    const Look there = look_at(next, wanted);
    const bool is_better = there.squared() < here.squared();  // false for NaN, too
    if (is_better) found.coefficients = next, here = there;
    damping = is_better ? std::max(damping / 4, 1e-9) : damping * 4;
  }
  return found;
}

Spectrum sample_reflectance(const SmoothReflectance& reflectance) {
  Spectrum spectrum;
  for (size_t i = 0; i < spectrum_size; i++) spectrum[i] = reflectance.at(nm_of(i));
  return spectrum;
}

}  // namespace wellspring::spectrum
