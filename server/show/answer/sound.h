// SPDX-License-Identifier: Apache-2.0
// The storyteller's voice on its way to the visitors. It speaks one language at a time, since one
// mouth is seen by all: that of whoever asked for the story, else the kiosk's, else the first
// listener's; subtitles stay everybody's own. Sound is sent in short pieces a little ahead of its
// time, so that a stop is heard at once and a visitor who comes later hears the rest. Nothing is
// made for those who do not listen. A visitor on a tour hears its narrator instead, and nobody else
// does.
#pragma once
#include <string>

#include "show/state/show.h"

namespace wellspring::show {

inline constexpr double sound_piece = 0.25;  // seconds of one packet
inline constexpr double sound_ahead = 1.2;   // seconds sent before they are due

// The language the storyteller speaks now.
std::string spoken_language(const Show& show, const Teller& teller);

// advance_voice with the speech of the show, and what follows from it.
VoiceEvents advance_speech(Show& show, Teller& teller, float dt);
VoiceEvents advance_narration(Show& show, Visitor& visitor, float dt);

// Sends what is due to every visitor who listens, and stops what has been stopped. After orders and
// advance_speech, once a tick.
void send_sounds(Show& show);

}  // namespace wellspring::show
