// SPDX-License-Identifier: Apache-2.0
// Chooses the gesture that is due: the story's before the situation's, and what a polite person
// does unasked (welcome, farewell, a nod while listening, an invitation to somebody who waits).
// State is a value.
#pragma once
#include <optional>

#include "avatar/body/gesture.h"
#include "avatar/mind/storyteller_io.h"
#include "base/rng.h"

namespace wellspring::avatar {

struct BodyLanguageState {
  double next_nod = 0;
  double attending_since = -1e30;  // time since which somebody has waited before the storyteller
  int invitations = 0;             // number of invitations given to this guest since then
  double answered = -1e30;         // time at which a visitor's gesture was last answered
  bool pointing = false;           // whether the story asked for pointing in the last tick
  vec3 pointed{0};                 // place pointed at, world
};

// A guest to whom nothing happens gets the first invitation after `patience_seconds`, and the next
// ones every `patience_again_seconds`.
inline constexpr double patience_seconds = 18, patience_again_seconds = 40;
inline constexpr int most_invitations = 3;

// Chooses the gesture. May shorten what `gesture` holds (a pointing hand sinks when the story has
// finished with the place). `to_body` maps the world to humanoid space, turned as the body faces.
GestureOrder choose_gesture(BodyLanguageState& state, GestureState& gesture,
                            const GestureLibrary& library, const StorytellerInput& input,
                            const StorytellerEvents& events, Mood mood, const mat4& to_body,
                            Rng& rng, double now);

}  // namespace wellspring::avatar
