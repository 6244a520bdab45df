// SPDX-License-Identifier: Apache-2.0
// Finds the pictures that an exhibit hangs: in its package, or on servers that its curator allows.
#pragma once
#include <string>

#include "show/exhibit/json_fields.h"

namespace wellspring::show {

// Reads `allowed_hosts` of exhibit.json; one that is no HOST or HOST:PORT is a problem.
void read_allowed_hosts(Exhibit& exhibit, FieldReader& root);

// Returns the path of a piece's `source` in the package, or the address that it is. Empty: it is
// neither, or its host is not allowed, which is noted.
std::string find_source(const Exhibit& exhibit, FieldReader& fields, const std::string& source);

}  // namespace wellspring::show
