// SPDX-License-Identifier: Apache-2.0
// Looks at what a file holds: units, order, gaps, noise, and values that cannot be.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "spectrum/read/raw_spectra.h"

namespace wellspring::spectrum {

// Finds the units that nobody has declared, and checks those that are; throws LoadError of `file`
// where numbers and words contradict each other, and where the numbers are in no unit of light
// that is seen. The units that are found are no longer `detect`.
void settle_units(const std::string& file, const SpectraChoice& choice, RawSpectra& spectra);

// Makes a spectrum of what was read, in settled units; none if it cannot be used. `notes` gets the
// reason, or what was put right.
std::optional<NamedSpectrum> check_spectrum(const RawSpectrum& raw, const RawSpectra& units,
                                            Quantity quantity, std::vector<SpectraNote>& notes);

}  // namespace wellspring::spectrum
