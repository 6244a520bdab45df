// SPDX-License-Identifier: Apache-2.0
// A storyteller as those see her who share her: who of the exhibit's it is, how she is, what she
// says. The house has one, for kiosks and for visitors who only look on. A visitor who calls her,
// hides her or asks for a story gets one of their own, so that nobody takes her from anybody. Of
// all of them there is one figure in the world, which is posed before each picture as its visitor's
// own teller is.
#pragma once
#include <cstddef>

#include "avatar/mind/storyteller.h"
#include "show/storyteller/held_prop.h"
#include "show/storyteller/sounding.h"
#include "show/storyteller/voice.h"

namespace wellspring::show {

struct Teller {
  uint64_t number = 0;  // Link::id of the visitor who called her first; 0: the house's
  size_t index = 0;     // of Exhibit::storytellers
  Storyteller storyteller;
  StorytellerState mind;
  Pose pose;
  Voice voice;
  Sounding sounding;
  HeldProp held;
  bool visible = true, humanlike = true;
  double agent_sent_at = -1e9;  // show time of the last agent message
  Mood agent_mood = Mood::idle;
};

}  // namespace wellspring::show
