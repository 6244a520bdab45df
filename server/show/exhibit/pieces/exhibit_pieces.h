// SPDX-License-Identifier: Apache-2.0
// Reads `pieces` of exhibit.json, which are no part of its glTF files: very large pictures that
// hang in the scene at their true size, or cover a material of it.
#pragma once
#include <vector>

#include "show/exhibit/exhibit.h"
#include "show/exhibit/json_fields.h"

namespace wellspring::show {

// Fills exhibit.pieces, and adds them to the scene and to exhibit.points. Call when the scene and
// the stories are there. A picture that cannot be read is a problem. `cache`: as for
// read_exhibit().
void read_pieces(Exhibit& exhibit, FieldReader& root, std::vector<Problem>& problems,
                 const std::string& cache = "");

}  // namespace wellspring::show
