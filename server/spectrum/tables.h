// SPDX-License-Identifier: Apache-2.0
// The tables of standards that are compiled in (tables/*.csv): each says its source.
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "spectrum/spectrum.h"

namespace wellspring::spectrum {

std::string_view observer_csv();    // x, y and z of CIE 1931
std::string_view daylight_csv();    // S0, S1 and S2
std::string_view illuminant_csv();  // FL, HP and LED

// Holds the columns of a table by name, in its order.
using StandardTables = std::vector<std::pair<std::string, SpectrumTable>>;
// Reads one of these: commas, names in the first line, wavelengths in the first column. Lines
// that begin with '#' are left out.
StandardTables read_standard(std::string_view csv);

}  // namespace wellspring::spectrum
