// SPDX-License-Identifier: Apache-2.0
// The kiosks of a package.
#pragma once
#include "show/exhibit/exhibit.h"
#include "show/exhibit/json_fields.h"

namespace wellspring::show {

// `kiosks` of exhibit.json, or of a house's file, which is read after it: what it says of a kiosk
// takes the place of what was said. The viewpoints and storytellers that they name are read
// already.
void read_kiosks(Exhibit& exhibit, Fields& root);

}  // namespace wellspring::show
