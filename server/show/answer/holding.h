// SPDX-License-Identifier: Apache-2.0
// Answers what guests hold to a kiosk's camera: its screen shows the object, and the storyteller,
// while she is there, asks for another view, names it, and tells its story (show/kiosk/holding.h).
#pragma once
#include "show/state/show.h"

namespace wellspring::show {

// Once a tick, after the kiosk's step. `hers`: the storyteller is with this kiosk.
void follow_holding(Show& show, Kiosk& kiosk, bool hers);

}  // namespace wellspring::show
