// SPDX-License-Identifier: Apache-2.0
// Cuts the wide picture of a wall's camera into its tiles' pictures (show/answer/walls.h). All that
// are made of one picture carry its number.
#pragma once
#include <vector>

#include "show/state/show.h"

namespace wellspring::show {

// Returns whether a moment may be sent: every tile can take a picture, but for those that are late.
bool tiles_may_take(const Visitor& camera, double time);
// Takes the encoder's picture of the camera, which is the one of that number and `view`, apart for
// those tiles that can take theirs, and notes that it is sent to them. Returns them; the others
// get the next that they can take.
std::vector<Visitor*> cut_into_tiles(Visitor& camera, const View& view, uint32_t frame,
                                     double time);

}  // namespace wellspring::show
