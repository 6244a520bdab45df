// SPDX-License-Identifier: Apache-2.0
// Spectra that somebody has measured, by name, and what is said of them.
#pragma once
#include <cstdint>
#include <string>

#include "spectrum/spectrum.h"

namespace wellspring::spectrum {

enum class Quantity : uint8_t { reflectance, power };
enum class WavelengthUnit : uint8_t { detect, nanometres, micrometres };
enum class ValueUnit : uint8_t { detect, fractions, per_cent };  // reflectances alone have it

// Says what a file holds. Units that are not declared, here or by a name in the file, are found by
// the size of the numbers.
struct SpectraChoice {
  Quantity quantity = Quantity::reflectance;
  WavelengthUnit wavelengths = WavelengthUnit::detect;
  ValueUnit values = ValueUnit::detect;
};

struct NamedSpectrum {
  std::string name, source;  // the source as the file says it, else the file
  SpectrumTable table;       // in nanometres and fractions, as it was read
  Spectrum spectrum;         // reflectances lie in 0 to 1, power is not negative
};

// Says what was put right in a file, or which of its spectra was left out.
struct SpectraNote {
  std::string where, what;
  bool is_left_out = false;
  bool operator==(const SpectraNote&) const = default;
};

}  // namespace wellspring::spectrum
