// SPDX-License-Identifier: Apache-2.0
// What visitors ask of the storyteller: to come, to go, to tell, to answer, to fall silent.
#pragma once
#include <optional>

#include "show/state/show.h"
#include "wire/json.h"

namespace wellspring::show {

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
