// SPDX-License-Identifier: Apache-2.0
// The lamps that a package names, out of its exhibit.json: see content/README.md.
#pragma once
#include "show/exhibit/json_fields.h"

namespace wellspring::show {

// Fills exhibit.lamps, and exhibit.scene.lamps one for one. Call when the scene is there.
void read_lamps(Exhibit& exhibit, Fields& root);

// As the exhibit is at first: which of its lamps are on, and the scene's.
std::vector<char> first_lamps(const Exhibit& exhibit);
LampLevels first_levels(const Exhibit& exhibit);

}  // namespace wellspring::show
