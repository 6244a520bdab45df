// SPDX-License-Identifier: Apache-2.0
// Holds what moves in the world of a running show: its storytellers with what they say and hold,
// and what animations move.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "avatar/mind/storyteller.h"
#include "show/moving/exhibit_scene.h"
#include "show/moving/figure.h"
#include "show/moving/prop.h"
#include "show/storyteller/held_prop.h"
#include "show/storyteller/voice.h"

namespace wellspring::show {

// Holds a storyteller as the visitors see it who share it: which of the exhibit's it is, how it is,
// what it says. The house has one, for kiosks and for visitors who only look on. A visitor who
// calls the storyteller, hides it or asks for a story gets one of their own, so that nobody takes
// it from anybody. All of them share one figure in the world, which is posed before each picture as
// the visitor's storyteller is.
struct Teller {
  uint64_t number = 0;  // Link::id of the visitor who first called it; 0: the house's
  size_t index = 0;     // index into Exhibit::storytellers
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

// Holds what the world was last posed by, for whoever has to pose another one alike.
struct PosedBy {
  double time = 0;  // show time
  size_t storyteller = 0;
  bool visible = false;
  Pose pose;
  mat4 placement{1};
  HeldProp held;
  std::vector<double> times;  // times of the exhibit's animations, seconds
  int shown_model = -1;       // index into ShowCast::held
  PropPose shown;
};

struct ShowCast {
  std::vector<Figure> figures;  // figures of all the exhibit's storytellers; hidden but for one
  std::vector<Prop> props;      // one for each of Exhibit::props; hidden but for what is held
  // models of what may be held to kiosks' cameras, by their ids; hidden but for what is held
  std::vector<std::pair<std::string, Prop>> held;
  // the house's storyteller: for kiosks, and for visitors who have none of their own
  Teller teller;
  Movers movers;            // meshes that the exhibit's animations move
  std::vector<Play> plays;  // state of each animation: the house's own, and that of shared ones
  SkinScratch scratch;
  SpeechSource speech;  // empty: the storyteller speaks by subtitles
  // counts all that is heard, the storyteller's utterances and narrators' alike
  uint32_t utterances = 0;
  size_t greetings = 0, farewells = 0;
  double behaved_at = -1;  // show time when the storyteller was last moved
  PosedBy posed_by;
  uint64_t pose_number = 1;  // number of the world's pose: counts commits
  // Teller::number of the storyteller whose pose the figures have; none yet
  uint64_t posed_as = ~uint64_t(0);
  // Link::id of the visitor whose own animations the world shows; 0: nobody's
  uint64_t posed_for = 0;
  // Link::id of the kiosk's page whose held object the world shows; 0: none is shown
  uint64_t posed_held = 0;
};

}  // namespace wellspring::show
