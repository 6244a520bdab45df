// SPDX-License-Identifier: Apache-2.0
// A group's visit: one visitor leads, others follow by the leader's code. Followers stand where the
// leader stands, see and hear the leader's storyteller, tour and lamps, and look round freely; a
// moment after the last turn their view comes back. Who walks off is away until they return.
#pragma once
#include <optional>

#include "show/state/show.h"
#include "wire/json.h"

namespace wellspring::show {

inline constexpr double look_round_seconds = 4;  // after the last turn the view comes back

// One order. Answers "unknown_group" for a code that nobody leads by.
std::optional<WireError> handle_group(Show& show, Visitor& visitor, const GroupOrder& order);
// Whether the visitor sees what a leader sees; their own words on it are refused.
std::optional<WireError> check_not_following(const Show& show, const Visitor& visitor);
// The visitor goes by themselves for now.
void go_away(Visitor& visitor);
// Where followers stand and look, from where their leader does; once a tick, after the leader has
// moved. Tells those whose leader has left.
void follow_leader(Show& show, Visitor& visitor, float dt);

}  // namespace wellspring::show
