// SPDX-License-Identifier: Apache-2.0
// Which animations of its scene an exhibit plays, and what they move.
#pragma once
#include "show/exhibit/json_fields.h"

namespace wellspring::show {

// `animations` of exhibit.json; after its objects.
void read_animations(Exhibit& exhibit, Fields& root);

// Takes what the exhibit's animations move out of its scene, and forgets all other animations.
void take_movers(Exhibit& exhibit);

}  // namespace wellspring::show
