// SPDX-License-Identifier: Apache-2.0
// What the house's day and its announcements are to the pages. What a closed house is to kiosks:
// show/answer/kiosks.h.
#pragma once
#include "show/state/show.h"

namespace wellspring::show {

// Once a tick, before visitors are read.
void follow_house(Show& show, Arrivals& arrivals);

// To a page that has just been welcomed: how the house is, and what is announced at the moment.
void tell_house(const Show& show, Visitor& visitor);

}  // namespace wellspring::show
