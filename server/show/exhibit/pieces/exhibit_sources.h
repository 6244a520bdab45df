// SPDX-License-Identifier: Apache-2.0
// Finds the pictures that an exhibit hangs: in its package, or on servers that its curator allows;
// reads what sources of a year have in common.
#pragma once
#include <string>

#include "show/exhibit/json_fields.h"
#include "store/bands/band_view.h"

namespace wellspring::show {

// Reads `allowed_hosts` of exhibit.json; one that is no HOST or HOST:PORT is a problem.
void read_allowed_hosts(Exhibit& exhibit, FieldReader& root);

// Returns the path of a piece's `source` in the package, or the address that it is. Empty: it is
// neither, or its host is not allowed, which is noted.
std::string find_source(const Exhibit& exhibit, FieldReader& fields, const std::string& source);

// Reads how a layer shows a picture of many bands: by a lamp, as one band, or in false colours.
BandView read_band_view(FieldReader& fields);

// Reads the year of a map or scan, and what it is called: layer.year, id, label and text.
void read_year(const Exhibit& exhibit, FieldReader& fields, PieceLayer& layer);

}  // namespace wellspring::show
