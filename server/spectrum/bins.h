// SPDX-License-Identifier: Apache-2.0
// Few spectral bins instead of three colours: a picture keeps the light of each bin, and a small
// matrix for each lamp makes X, Y and Z of it, so that another lamp costs a product, not a picture.
//
// A bin knows the mean of a reflectance, weighted by what the eye sees of its wavelengths. From the
// means of all bins the reflectance is estimated (Wiener's estimate) as if reflectances changed
// from wavelength to wavelength as a Markov process does; this is exact for grey surfaces and knows
// nothing of any pigment.
#pragma once
#include <vector>

#include "base/vec.h"
#include "spectrum/spectrum.h"

namespace wellspring::spectrum {

// Holds bins that lie side by side.
struct SpectralBins {
  std::vector<double> edges_nm;   // one more than bins
  std::vector<Spectrum> weights;  // each: the wavelengths' weights in its mean; their sum is 1
  std::vector<Spectrum> shapes;   // each: the reflectance that a mean of 1 in it stands for
  size_t count() const { return weights.size(); }
};

// Says what a bin's mean stands for: a shape by the estimate described above, or the same
// reflectance throughout the bin.
enum class BinShapes : uint8_t { estimated, even };

// So many keep the colours of 54 historic pigments under 8 lamps within 0.8 of CIEDE2000, and
// within 1.3 after a second reflection (docs/benchmarks/lamps.md); 8 within 2.3 and 4.6.
inline constexpr int usual_bins = 12;

// Returns 2 to 32 bins over 360 to 830 nm that hold equal shares of WavelengthDensity. Takes a
// millisecond or two.
SpectralBins make_bins(int count = usual_bins, BinShapes shapes = BinShapes::estimated);
// Returns the mean of a reflectance in each bin.
std::vector<double> bin_means(const SpectralBins& bins, const Spectrum& reflectance);

// Returns what a mean of 1 in each bin adds to X, Y and Z under a lamp; Y of white is 1. Takes some
// ten microseconds, so it may be called whenever a lamp changes.
std::vector<dvec3> lamp_matrix(const SpectralBins& bins, const Spectrum& power);
// Returns what red, green and blue of a surface each add to its mean in every bin, if nothing but
// its colour under D65 is known: the estimate described above. White is 1 in each bin.
std::vector<dvec3> color_means(const SpectralBins& bins);
// Returns X, Y and Z of means.
dvec3 xyz_of_means(const std::vector<dvec3>& matrix, const std::vector<double>& means);

}  // namespace wellspring::spectrum
