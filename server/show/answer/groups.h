// SPDX-License-Identifier: Apache-2.0
// A group's visit: one visitor leads, others follow by the leader's code. Followers stand where the
// leader stands, see and hear the leader's storyteller, tour and lamps, and look round freely; a
// moment after the last turn their view comes back. Who walks off is away until they return.
#pragma once
#include <optional>
#include <string>

#include "show/state/show.h"
#include "wire/json.h"

namespace wellspring::show {

inline constexpr double look_round_seconds = 4;  // after the last turn the view comes back

// One order. Answers "unknown_group" for a code that nobody leads by.
std::optional<WireError> handle_group(ShowVisits& visits, Visitor& visitor,
                                      const GroupOrder& order);
// Whether the visitor sees what a leader sees; their own words on it are refused.
std::optional<WireError> check_not_following(const ShowVisits& visits, const Visitor& visitor);
// The visitor goes by themselves for now.
void go_away(Visitor& visitor);
// Puts followers where their leader stands and looks; called once a tick, after the leader has
// moved. Tells those whose leader has left.
void follow_leader(ShowVisits& visits, double time, Visitor& visitor, float dt);

// The functions below say where the screens of kiosks are in the exhibit.

// Returns where a kiosk's screen is a window: its own viewpoint, that of its storyteller, or of
// whoever is there; the exhibit's start if nobody is. Index into Exhibit::viewpoints.
int kiosk_viewpoint(const ExhibitStage& stage, const ShowCast& cast, const std::string& kiosk);
View kiosk_window(const Show& show, const std::string& kiosk);

// A step of a kiosk's page: while it stands at the kiosk's viewpoint, its picture is seen from
// where the head before the screen is (show/kiosk/kiosk.h), as far as no wall is in the
// way.
void look_through(const Show& show, Visitor& page, float dt);

// Visitors ask the storyteller to come, to go, to tell, to answer, to fall silent.

// Carries it out, and gives who orders something a storyteller of their own where the exhibit does
// not share it; the error to send back, if any.
std::optional<WireError> handle_storyteller(Show& show, Visitor& visitor,
                                            const StorytellerOrder& order);
// The answer is sent to be read, and said where there is somebody to say it.
std::optional<WireError> ask(Show& show, Visitor& visitor, const Ask& question);

// The storyteller is there for those who are there: a story that was paused by somebody who has
// left since is over, and so is any story when nobody is left. After visitors have left.
void forget_absent_listeners(Show& show);
// The storyteller says nothing more, and its subtitle goes.
void fall_silent(Show& show, Teller& teller);
// Subtitles go with what is broken off.
void clear_subtitle(Visitor& visitor);

}  // namespace wellspring::show
