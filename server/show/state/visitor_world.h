// SPDX-License-Identifier: Apache-2.0
// The one world as a visitor sees it: whose teller is there and how she stands, which lamps are on.
// It is changed between two things that are drawn, only while the renderer is idle. For visitors
// who see the same it stays as it is.
#pragma once
#include "show/state/show.h"

namespace wellspring {

// Shows that teller alone, as it is now.
void pose_world(Show& show, const Teller& teller);
// For a new picture: the visitor's lamps, the teller as it is now.
void begin_world_of(Show& show, Visitor& visitor);
// For more of what was begun: the teller as it was last posed, unless somebody else's was since.
void go_on_in_world_of(Show& show, Visitor& visitor);
// Whether two visitors see the same lamps and the same teller.
bool see_the_same(const Show& show, const Visitor& a, const Visitor& b);

}  // namespace wellspring
