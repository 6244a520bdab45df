// SPDX-License-Identifier: Apache-2.0
// Files of an exhibit package, named in its JSON.
#pragma once
#include "show/exhibit/json_fields.h"

namespace wellspring::show {

// The path of a file inside the package's folder that is there. Empty when not, with the problem
// noted at `field`; also for an empty name.
std::string package_file(Fields& fields, const char* field, const std::string& folder,
                         const std::string& name);

}  // namespace wellspring::show
