// SPDX-License-Identifier: Apache-2.0
#include "pigments.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "spectrum/read/spectra_file.h"

namespace wellspring::test {
namespace {

// Makes pigments of one edge or one band, as those of many earths, yellows and blues are roughly.
std::vector<Spectrum> make_pigments() {
  std::vector<Spectrum> pigments;
  for (int i = 0; i < 54; i++) {
    Spectrum one;
    const double middle = 430 + 230 * (i % 18) / 17.0, width = 10 + 12 * (i / 18);
    for (size_t w = 0; w < spectrum_size; w++) {
      const double off = (nm_of(w) - middle) / width;
      one[w] = i % 3 == 2 ? 0.05 + 0.5 * std::exp(-0.08 * off * off)
                          : 0.05 + 0.8 / (1 + std::exp(i % 3 == 0 ? -off : off));
    }
    pigments.push_back(one);
  }
  return pigments;
}

}  // namespace

Pigments find_pigments(const BenchOptions& options) {
  const char* data = std::getenv("WELLSPRING_DATA");
  const std::string folder = data ? data : options.content + "/../../shared/data";
  const std::string file = folder + "/10_exhibits/spectra/pigments/paints.csv";
  if (!std::filesystem::exists(file)) return {make_pigments(), "made"};
  Pigments pigments{{}, "measured"};
  for (const NamedSpectrum& one : read_spectra(file).spectra)
    pigments.reflectances.push_back(one.spectrum);
  return pigments;
}

}  // namespace wellspring::test
