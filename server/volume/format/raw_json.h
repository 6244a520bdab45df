// SPDX-License-Identifier: Apache-2.0
// Raw samples in a file, which a JSON file beside them describes.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "volume/format/stored_volume.h"

namespace wellspring::volume {

// Reads NAME.json. Throws LoadError that names the field.
StoredVolume read_raw_json(const std::string& file);
// Returns the JSON Schema of such a file.
nlohmann::ordered_json raw_json_schema();

// Returns the description beside a file of raw samples, NAME.json or NAME.EXTENSION.json; empty:
// there is none.
std::string find_raw_json(const std::string& file);

}  // namespace wellspring::volume
