// SPDX-License-Identifier: Apache-2.0
// Where visitors' eyes are likely to be.
#pragma once
#include <vector>

#include "show/exhibit/exhibit.h"

namespace wellspring::show {

// The viewpoints, and places on the way between them, in scene coordinates.
std::vector<vec3> eye_places(const Exhibit& exhibit);
// These, and an even choice of where visitors may walk.
std::vector<vec3> all_eye_places(const Exhibit& exhibit);

}  // namespace wellspring::show
