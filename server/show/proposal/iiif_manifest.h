// SPDX-License-Identifier: Apache-2.0
// Reads a manifest of the IIIF Presentation API, version 2 or 3: which pictures it shows, and what
// it says about them. https://iiif.io/api/presentation/3.0/
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "show/exhibit/exhibit.h"

namespace wellspring::show {

// Texts are plain, without markup. Their language is "" where the manifest names none.
struct ManifestPicture {
  std::string where;   // place of its canvas: a JSON pointer
  std::string source;  // address of its image service, or a file as the manifest names it
  bool is_service = false;
  double width = 1, height = 1;   // the canvas's, in units of its own
  std::optional<double> width_m;  // metres, by the physical dimension service
  LocalText label, text;
  std::map<std::string, LocalText> provenance;  // by element of the Dublin Core
};

struct IiifManifest {
  std::string id;  // its address
  LocalText label, text;
  std::vector<ManifestPicture> pictures;
  std::vector<std::string> told;  // sentences about what is left out
};

inline constexpr size_t most_canvases = 10'000;

// Throws a LoadError that names file and place if it is no manifest, or shows no picture.
IiifManifest load_manifest(const std::string& file);

}  // namespace wellspring::show
