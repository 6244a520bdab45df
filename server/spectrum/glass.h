// SPDX-License-Identifier: Apache-2.0
// Glass, gems and liquids: how strongly light of each wavelength is bent and taken up. Formulas are
// numbered as by refractiveindex.info, whose files spectrum/read/dispersion_file.h reads.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "spectrum/spectrum.h"

namespace wellspring::spectrum {

// Spectral lines at which glass is described.
inline constexpr double line_F_nm = 486.1327, line_d_nm = 587.5618, line_C_nm = 656.2725;

// Holds one ray's index of refraction, by a formula or a table, and the extinction coefficient.
struct Dispersion {
  std::string name, source;
  int formula = 0;                   // 1 to 9; 0: the table
  std::vector<double> coefficients;  // for wavelengths in micrometres
  SpectrumTable index, extinction;   // empty: not known
  double low_nm = 0, high_nm = 0;    // range of the index
  std::vector<std::string> notes;    // things in the file that were put right
};

// Returns the index of refraction; none beyond the range, which is not extrapolated, or where a
// formula gives no number above 0.
std::optional<double> index_at(const Dispersion& glass, double nm);
// Returns Abbe's number, (n_d - 1) / (n_F - n_C): high where colours are hardly separated.
std::optional<double> abbe_number(const Dispersion& glass);
// Returns the share of light that passes so many metres, without reflections at the surfaces; none
// where no extinction is known.
std::optional<double> transmittance_at(const Dispersion& glass, double nm, double metres);

}  // namespace wellspring::spectrum
