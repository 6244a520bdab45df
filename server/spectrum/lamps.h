// SPDX-License-Identifier: Apache-2.0
// Lamps by name: CIE illuminants, blackbodies and spectral lines.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "spectrum/spectrum.h"

namespace wellspring::spectrum {

// Names a lamp and holds its power over wavelength, in a unit of its own.
struct LampSpectrum {
  std::string name, about;  // "candle", "blackbody of 1930 K"
  Spectrum power;
};

// Returns the radiance of a blackbody by Planck's law, 1 at 560 nm.
Spectrum blackbody(double kelvin);
// Returns daylight of a correlated colour temperature from 4000 to 25000 K by its components
// (CIE 15:2018, 4.1.2), 1 at 560 nm.
Spectrum daylight(double kelvin);

// Returns the lamp of this name, or none. Besides those of lamp_names() there are blackbodies
// ("2856K"), daylight of any temperature ("D5700K") and lines ("589.0*2+589.6": nanometres and, if
// not 1, power).
std::optional<LampSpectrum> find_lamp(const std::string& name);
// Lists lamps that have a name: E, A, daylights, candle and bulbs, discharge lamps, FL, HP, LED.
std::vector<std::string> lamp_names();

}  // namespace wellspring::spectrum
