// SPDX-License-Identifier: Apache-2.0
// Puts the one world into the state that a visitor sees: whose storyteller is there and how it
// stands, which lamps are on, what pieces show, where animations are, how blades of grass stand.
// The world is changed between two things that are drawn, only while the renderer is idle. For
// visitors who see the same it stays as it is.
#pragma once
#include "show/state/show.h"

namespace wellspring::show {

// Holds where the world shows the object that a kiosk's guest holds up; size 0: none.
struct ShownHeld {
  int model = -1;  // index into ShowCast::held
  PropPose pose;
};
// Shows that storyteller alone, as it is now, animations at these times, seconds of each, and what
// is held up.
void pose_world(ExhibitStage& stage, ShowCast& cast, double time, const Teller& teller,
                const std::vector<double>& times, const ShownHeld& held = {});
// Returns the visitor's wish of what pieces show; the leader's, if there is one.
const PieceChoices& pieces_of(const ShowVisits& visits, const Visitor& visitor);
// Makes the visitor's pictures follow that wish and the visitor's language from the next one on, if
// they have changed, or volumes in new light. Call it while none is drawn for that visitor.
void follow_wish(const Show& show, Visitor& visitor);
// Lets a piece of the visitor's become what a mark says, within glide_seconds.
void see_told(const Exhibit& exhibit, double time, const std::string& piece, const PieceMark& mark,
              Visitor& visitor);
inline constexpr double glide_seconds = 1.5;
// Puts what is shown of pieces into the world, while nothing reads it.
void show_pieces_of(ExhibitStage& stage, const ShownPieces& shown);
// Prepares the world for a new picture: the visitor's lamps, and the storyteller, lawns and the
// visitor's animations as they are now.
void begin_world_of(Show& show, Visitor& visitor);
// Prepares the world for more of what was begun: it stays as last posed, unless that was for
// somebody who sees others.
void go_on_in_world_of(Show& show, Visitor& visitor);
// Returns whether two visitors see the same lamps, hour, pieces, animations and storyteller.
bool see_the_same(const ShowCast& cast, const ShowVisits& visits, const Visitor& a,
                  const Visitor& b);

}  // namespace wellspring::show
