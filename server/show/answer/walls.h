// SPDX-License-Identifier: Apache-2.0
// Screens of walls come and go. A wall shows the visit of its camera, which has no page of its own:
// its wide picture is drawn as any visitor's, and cut into the tiles' pictures
// (show/draw/tiles.h). It comes with the first tile and goes with the last, and follows a page that
// leads the wall, as groups follow a leader (show/answer/groups.h). Pictures of one moment have one
// number. Tiles decode them and say so, and show them when all have: they are told then.
#pragma once
#include "show/state/show.h"

namespace wellspring::show {

// Notes who has a part in which wall, and tells tiles which moments to show. Once a tick, after
// visitors have come, spoken and gone.
void follow_walls(Show& show);

}  // namespace wellspring::show
