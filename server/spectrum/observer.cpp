// SPDX-License-Identifier: Apache-2.0
#include "spectrum/observer.h"

#include "spectrum/tables.h"

namespace wellspring::spectrum {

const std::array<dvec3, spectrum_size>& matching_functions() {
  static const std::array<dvec3, spectrum_size> made = [] {
    const StandardTables tables = read_standard(observer_csv());
    std::array<dvec3, spectrum_size> functions;
    for (int c = 0; c < 3; c++) {
      const Spectrum one = interpolate_sprague(tables[size_t(c)].second);
      for (size_t i = 0; i < spectrum_size; i++) functions[i][c] = one[i];
    }
    return functions;
  }();
  return made;
}

dvec3 xyz_of(const Spectrum& power) {
  dvec3 sum(0);
  for (size_t i = 0; i < spectrum_size; i++) sum += power[i] * matching_functions()[i];
  return sum;
}

LampObserver::LampObserver(const Spectrum& power) {
  const double scale = 1 / xyz_of(power).y;
  for (size_t i = 0; i < spectrum_size; i++) {
    weights_[i] = scale * power[i] * matching_functions()[i];
    white_ += weights_[i];
  }
}

dvec3 LampObserver::xyz(const Spectrum& reflectance) const {
  dvec3 sum(0);
  for (size_t i = 0; i < spectrum_size; i++) sum += reflectance[i] * weights_[i];
  return sum;
}

}  // namespace wellspring::spectrum
