// SPDX-License-Identifier: Apache-2.0
// Describes a picture of many bands: the light of each that the surface sends back. The description
// is JSON, in the ImageDescription of a TIFF, or in a file beside it, NAME.bands.json. Bands are a
// TIFF's samples, or its pages, or files of their own, which only `wellspring import bands` reads.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/layers.h"

namespace wellspring::store {

inline constexpr size_t most_bands = 512;
inline constexpr double shortest_nm = 100, longest_nm = 20000;

// Holds a description. A code stands for the reflectance ((code - black) / (white - black)) to the
// power `gamma`.
struct Bands {
  std::vector<double> nm;     // middle of each band, in nanometres; rises strictly
  std::vector<double> white;  // codes of a reflectance of 1: one for all, or for each band;
                              // empty: the largest code of the file, 1 of floats
  double black = 0, gamma = 1;
  std::string source;              // who measured it, whose it is
  std::vector<std::string> files;  // one with all bands, or one for each; empty: the TIFF itself

  double white_of(size_t band, double largest) const {
    return white.empty() ? largest : white.size() == 1 ? white[0] : white[band];
  }
};

// Reads a description; `file` is named in errors. Throws LoadError that names the field.
Bands read_bands(const std::string& file, const std::string& text);
// Writes one for a file's ImageDescription.
std::string write_bands(const Bands& bands);
// Returns the JSON Schema of NAME.bands.json.
nlohmann::ordered_json bands_schema();

// Returns the path of NAME.bands.json beside NAME.tif, whether or not it is there.
std::string bands_file_of(const std::string& tiff);
// Returns the description of a TIFF: its ImageDescription, if that is one, else that of
// bands_file_of(); none: it has no bands. Throws LoadError for one that is wrong.
std::optional<Bands> find_bands(const std::string& tiff, const std::string& image_description);

}  // namespace wellspring::store
