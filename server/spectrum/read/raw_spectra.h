// SPDX-License-Identifier: Apache-2.0
// Numbers as they stand in a file, before anybody has looked at them.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "spectrum/measured.h"

namespace wellspring::spectrum {

inline constexpr size_t most_spectra = 4096;  // a file may have

struct RawSample {
  double wavelength, value;  // NaN: the value is missing
  int line;                  // 0: the place is not known
};

struct RawSpectrum {
  std::string name, source;
  std::vector<RawSample> samples;
};

// Holds the spectra of a file, with the units that it declares by itself.
struct RawSpectra {
  std::vector<RawSpectrum> all;
  WavelengthUnit wavelengths = WavelengthUnit::detect;
  ValueUnit values = ValueUnit::detect;
  std::string declared;  // the words by which it does
};

RawSpectra read_raw_table(const std::string& file, std::string_view text);
RawSpectra read_raw_json(const std::string& file, std::string_view text);

}  // namespace wellspring::spectrum
