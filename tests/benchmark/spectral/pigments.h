// SPDX-License-Identifier: Apache-2.0
// Gives reports about spectra the same pigments and lamps.
#pragma once
#include <string>
#include <vector>

#include "benchmark/report.h"
#include "spectrum/spectrum.h"

namespace wellspring::test {

inline constexpr const char* lamp_dial[] = {"candle", "A",      "north-light", "LED-B1",
                                            "LED-B3", "LED-V2", "FL11",        "HP1"};

struct Pigments {
  std::vector<Spectrum> reflectances;
  std::string kind;  // "measured" or "made"
};
// Reads the measured pigments that lie beside the project's folder, if there are some; else makes
// as many.
Pigments find_pigments(const BenchOptions& options);

}  // namespace wellspring::test
