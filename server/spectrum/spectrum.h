// SPDX-License-Identifier: Apache-2.0
// Spectra: a quantity over the wavelength of light, in nanometres in air. A table is what a file or
// a standard says; a Spectrum is its means over single nanometres, for sums and products.
#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "base/layers.h"

namespace wellspring::spectrum {

inline constexpr int first_nm = 360, last_nm = 830;
inline constexpr size_t spectrum_size = size_t(last_nm - first_nm + 1);

// Holds the means of a quantity over the nanometre around each of 360, 361 ... 830 nm.
using Spectrum = std::array<double, spectrum_size>;

// Holds a quantity as it was measured or published. Wavelengths rise strictly; there is at least
// one.
struct SpectrumTable {
  std::vector<double> nm, value;
};

inline double nm_of(size_t i) { return double(first_nm) + double(i); }

// Returns the same value everywhere.
Spectrum even_spectrum(double value);
// Returns the value by straight lines between those of the table; beyond its ends they go on.
double value_at(const SpectrumTable& table, double nm);
// Returns the table's means over each nanometre, by straight lines between its values, so that
// noise of finer steps is averaged.
Spectrum resample(const SpectrumTable& table);
// Returns values between those of a table of equal steps, at least six, by Sprague's polynomials
// of the fifth degree (CIE 167:2005), which follow smooth functions closer than straight lines.
Spectrum interpolate_sprague(const SpectrumTable& table);
// Adds a line of this power, shared between the two nearest nanometres. Lines beyond 360 to 830 nm
// add nothing, as they are not seen.
void add_line(double nm, double power, Spectrum& spectrum);
// Returns the product, wavelength by wavelength.
Spectrum product(const Spectrum& a, const Spectrum& b);

}  // namespace wellspring::spectrum
