// SPDX-License-Identifier: Apache-2.0
#include "spectrum/band_matrix.h"

#include "spectrum/observer.h"

namespace wellspring::spectrum {

std::vector<dvec3> band_matrix(const std::vector<double>& nm, const Spectrum& power) {
  const LampObserver lamp(power);
  std::vector<dvec3> matrix;
  for (size_t band = 0; band < nm.size(); band++) {
    // This band alone is 1: straight lines between bands are sums of such tents.
    SpectrumTable tent;
    for (size_t i = band > 0 ? band - 1 : 0; i < std::min(band + 2, nm.size()); i++) {
      tent.nm.push_back(nm[i]);
      tent.value.push_back(i == band ? 1 : 0);
    }
    matrix.push_back(lamp.xyz(resample(tent)));
  }
  return matrix;
}

}  // namespace wellspring::spectrum
