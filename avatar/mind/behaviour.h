// SPDX-License-Identifier: Apache-2.0
// What the storyteller is doing: idle -> noticing -> greeting -> attending (or telling) -> farewell
// -> idle. Time is an argument. Detectors flicker: a person is somebody seen for 0.25 s, lost after
// 2 s, and the same one when another number stands where it stood.
#pragma once
#include "avatar/mind/storyteller_io.h"

namespace wellspring::avatar {

struct BehaviourState {
  struct Person {
    uint64_t id = 0;
    vec3 head{0};
    vec3 rotation{0};
    double first_seen = 0, last_seen = 0, greeted_at = -1e30;
    bool here = false;  // in this tick's input
    bool greeted = false;
  };
  std::vector<Person> people;  // in front of kiosks, now or a moment ago
  Mood mood = Mood::idle;
  double since = 0;  // when the mood began
  double last_motion = -1e30;
  double last_company = -1e30;  // when a kiosk guest was last seen
  double last_greeting = -1e30;
  uint64_t visit = 0;      // of the people
  bool company = false;    // somebody was greeted and not yet bid farewell
  uint64_t addressed = 0;  // the last one greeted
};

inline constexpr double confirm_seconds = 0.25, lost_seconds = 2.0, greeting_seconds = 3.0,
                        farewell_seconds = 3.0;

// Overwrites `events`. `now` must not run backwards.
void decide(BehaviourState& state, const StorytellerInput& input, double now,
            StorytellerEvents& events);

}  // namespace wellspring::avatar
