// SPDX-License-Identifier: Apache-2.0
// Reads and validates a whole exhibit package; every problem is listed with file and place, not
// only the first. Blocks on the disk; called at start and by `./wellspring check`; may be cancelled
// (base/worker.h).
#pragma once
#include <string>
#include <vector>

#include "show/exhibit/exhibit.h"
#include "show/exhibit/json_fields.h"

namespace wellspring::show {

// `folder` holds exhibit.json; the folder's name is the exhibit's id. Appends to `problems`; the
// exhibit is usable when none of them is fatal. All of the scene stands at rest.
// `cache`: folder that keeps what takes long to make; without one scans are made coarsely.
Exhibit read_exhibit(const std::string& folder, std::vector<Problem>& problems,
                     const std::string& cache = "");
// The same as it is played: what its animations move is no part of the scene any more. Throws
// ExhibitError when a problem is fatal; logs the others.
Exhibit load_exhibit(const std::string& folder, const std::string& cache = "");

// Returns the JSON Schema of exhibit.json, out of the same list of fields.
nlohmann::ordered_json exhibit_schema();

}  // namespace wellspring::show
