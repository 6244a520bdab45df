// SPDX-License-Identifier: Apache-2.0
// The one world as a visitor sees it: whose teller is there and how she stands, which lamps are on,
// where animations are. It is changed between two things that are drawn, only while the renderer is
// idle. For visitors who see the same it stays as it is.
#pragma once
#include "show/state/show.h"

namespace wellspring::show {

// Shows that teller alone, as it is now, and animations at these times, seconds of each.
void pose_world(Show& show, const Teller& teller, const std::vector<double>& times);
// For a new picture: the visitor's lamps, the teller and the visitor's animations as they are now.
void begin_world_of(Show& show, Visitor& visitor);
// For more of what was begun: as it was last posed, unless for somebody who sees others.
void go_on_in_world_of(Show& show, Visitor& visitor);
// Whether two visitors see the same lamps, hour, animations and teller.
bool see_the_same(const Show& show, const Visitor& a, const Visitor& b);

}  // namespace wellspring::show
