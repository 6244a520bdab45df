// SPDX-License-Identifier: Apache-2.0
// What goes into a tick of the storyteller and what comes out of it.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "avatar/face/emotion.h"
#include "avatar/story/story_cue.h"
#include "base/vec.h"

namespace wellspring::avatar {

// Somebody the storyteller can be aware of. Coordinates are the world's (as `placement`).
struct Guest {
  uint64_t id = 0;
  vec3 head{0};        // between the eyes
  vec3 rotation{0};    // yaw, pitch, roll of the head relative to facing the storyteller squarely;
                       // yaw positive to the guest's right, pitch positive up
  bool kiosk = false;  // a person in front of a kiosk (is greeted); else a remote visitor's camera
                       // (is looked at)
  std::optional<Emotions> expression{};  // as far as the kiosk sees it
  std::string gesture{};                 // the guest's own; "wave" and "nod" are answered
};

// What the storyteller is doing, for the page and for tests.
enum class Mood : uint8_t { idle, noticing, greeting, attending, telling, farewell };
const char* to_string(Mood mood);

struct StorytellerInput {
  double time = 0;            // seconds, the show's clock
  float dt = 0;               // since the last tick; any size from 0 to hours is safe
  bool kiosk_motion = false;  // something moves before a kiosk but nobody is recognised yet
  std::vector<Guest> guests;
  bool staying = false;   // a kiosk's guest is taken to be there still, seen or not: no farewell
  bool met = false;       // the kiosk's guests were greeted before, and are not again
  bool parting = false;   // they have just left: farewell
  uint64_t visit = 0;     // of these guests: who was known from another is forgotten
  bool humanlike = true;  // noise for human-like behaviour; off: bit-identical replays
  float speaking = 0;     // mouth activity 0..1: it says something right now
  // Mouth shapes of the speech that is heard (order of Rig::viseme); without them the mouth moves
  // as if it spoke.
  std::optional<std::array<float, 15>> visemes;
  bool telling =
      false;  // a story is being told (Mood::telling while no greeting or farewell is due)
  float viewer_distance =
      0;           // metres to the nearest who sees it: how much of it needs to run (lod.h)
  StoryCue story;  // what its text asks of face, eyes and hands
};

// What happened in this tick, for subtitles and messages.
struct StorytellerEvents {
  bool greeted = false, farewelled = false;
  uint64_t guest = 0;  // whom it concerns
};

}  // namespace wellspring::avatar
