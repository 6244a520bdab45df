// SPDX-License-Identifier: Apache-2.0
// Objects in words: label, provenance and links of each, and the map on which they stand.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "show/exhibit/exhibit.h"
#include "show/visit/walk_map.h"

namespace wellspring::show {

// [{id, title, position, text, story, provenance, manifest, around}], texts in all languages; of
// the last five those that there are. provenance: [{element, value}] in the order of the Dublin
// Core.
nlohmann::json describe_objects(const Exhibit& exhibit);
// The same with texts in one language; those that have a title.
nlohmann::json describe_objects(const Exhibit& exhibit, const std::string& lang);

// GET .../map: the ground from above, JSON. rows[i][j] is the cell at corner + cell * (j, i) of x
// and z: 'o' where there is room to walk, 'x' where something stands, '.' elsewhere.
std::string describe_map(const Exhibit& exhibit, const WalkMap& map);

}  // namespace wellspring::show
