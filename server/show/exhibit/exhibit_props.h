// SPDX-License-Identifier: Apache-2.0
// Things that storytellers can hold, out of exhibit.json and their glTF files: see
// content/README.md.
#pragma once
#include "show/exhibit/json_fields.h"

namespace wellspring::show {

// Bounds of what a hand holds: triangles, texels of its pictures, metres from the hand, lights.
inline constexpr size_t most_prop_triangles = 20'000, most_prop_texels = size_t(1) << 22,
                        most_prop_lights = 4;
inline constexpr float farthest_prop = 1.5f;

// Fills exhibit.props. Call when the storytellers are there. What is too large, or cannot be read
// or held, is a problem.
void read_props(Exhibit& exhibit, Fields& root, std::vector<Problem>& problems);

}  // namespace wellspring::show
