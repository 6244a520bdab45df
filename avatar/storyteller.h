// SPDX-License-Identifier: Apache-2.0
// The storyteller's mind and body, tick by tick: whom it notices, what it says, how it stands. State is a
// value; time is an argument, so a test can run hours in a moment and a replay is bit-identical.
// Source: the storyteller and kiosk paper (agent's two layers, lazy mirror, farewell override).
#pragma once
#include <string>
#include <vector>

#include "avatar/character.h"
#include "avatar/pose.h"

namespace wellspring {

// Somebody the storyteller can be aware of. Coordinates are the world's (as `placement`).
struct Guest {
  uint32_t id = 0;
  vec3 head{0};      // between the eyes
  vec3 rotation{0};  // yaw, pitch, roll of the head relative to facing the storyteller squarely
  bool kiosk = false;  // a person in front of a kiosk (is greeted); else a remote visitor's camera (is looked at)
};

// What the storyteller is doing, for the page and for tests.
enum class Mood : uint8_t { idle, noticing, greeting, attending, telling, farewell };
const char* to_string(Mood mood);

struct StorytellerInput {
  double time = 0;  // seconds, the show's clock
  float dt = 0;     // since the last tick; any size from 0 to hours is safe
  bool kiosk_motion = false;  // something moves before a kiosk but nobody is recognised yet
  std::vector<Guest> guests;
  bool humanlike = true;  // noise for human-like behaviour; off: bit-identical replays
  float speaking = 0;     // mouth activity 0..1: it says something right now
  bool telling = false;   // a story is being told (Mood::telling while no greeting or farewell is due)
};

// What happened in this tick, for subtitles and messages.
struct StorytellerEvents {
  bool greeted = false, farewelled = false;
  uint32_t guest = 0;  // whom it concerns
};

// The figure and where it stands; what never changes while an exhibit runs.
struct Storyteller {
  const Character* character = nullptr;  // borrowed
  mat4 placement{1};                     // humanoid space to world
};

// Everything remembered from tick to tick, a plain value: copy it and the copy goes on alike.
struct StorytellerState {
  Mood mood = Mood::idle;
};

// One tick: notices, decides, moves. Overwrites `pose` and `events`. Never fails.
void tick_storyteller(StorytellerState& state, const Storyteller& storyteller,
                      const StorytellerInput& input, Pose& pose, StorytellerEvents& events);

// Where the storyteller looks, for messages and measurements.
struct StorytellerGaze {
  vec3 target{0};             // world: what it wants to look at
  float yaw = 0, pitch = 0;   // of its line of sight as posed now, from the body's facing; radians, yaw
                              // positive to its own left, pitch positive up
  uint32_t guest = 0;         // whom it looks at; 0: nobody
};
StorytellerGaze eval_gaze(const StorytellerState& state, const Storyteller& storyteller, const Pose& pose);

}  // namespace wellspring
