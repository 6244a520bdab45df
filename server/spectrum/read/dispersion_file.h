// SPDX-License-Identifier: Apache-2.0
// Reads a file of refractiveindex.info's database (YAML): the index of refraction of glass, a gem
// or a liquid by formula or table, and its extinction.
#pragma once
#include <string>
#include <string_view>

#include "spectrum/glass.h"

namespace wellspring::spectrum {

// Throws LoadError with the file's line. A file of extinction alone is refused: light has to be
// bent by something.
Dispersion read_dispersion(const std::string& file);
Dispersion read_dispersion_text(const std::string& file, const std::string& text);

}  // namespace wellspring::spectrum
