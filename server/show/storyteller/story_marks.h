// SPDX-License-Identifier: Apache-2.0
// A story's marks on the stage of an exhibit: names become places in the world, for the
// storyteller's body.
#pragma once
#include "avatar/story/story_cue.h"
#include "show/exhibit/exhibit.h"
#include "show/storyteller/voice.h"

namespace wellspring::show {

// What the story asks of the body now; nothing while nothing marked is told. `events` of this tick.
StoryCue make_cue(const Exhibit& exhibit, const Voice& voice, const VoiceEvents& events);

}  // namespace wellspring::show
