// SPDX-License-Identifier: Apache-2.0
// The objects that a package names, out of its exhibit.json: see content/README.md.
#pragma once
#include "show/exhibit/json_fields.h"

namespace wellspring::show {

// Fills exhibit.points. Call when the scene and the stories are there; without a scene no name is
// missed.
void read_objects(Exhibit& exhibit, Fields& root);

// The fifteen elements of the Dublin Core (ISO 15836-1), in the order in which they are shown.
inline constexpr const char* provenance_elements[] = {
    "title",    "creator",     "contributor", "date",     "type",
    "format",   "description", "subject",     "source",   "publisher",
    "language", "coverage",    "identifier",  "relation", "rights"};

}  // namespace wellspring::show
