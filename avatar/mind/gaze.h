// SPDX-License-Identifier: Apache-2.0
// Finds where the storyteller looks, and how its eyes, head and chest share the way: eyes first and
// fast, then the head, then the chest. A listener is never shown a back: places behind are looked
// at as far as eyes, head and chest go. Angles are in humanoid space, about +Y from +Z (positive to
// the storyteller's own left) and up.
#pragma once
#include <optional>
#include <span>

#include "avatar/figure/rig.h"
#include "avatar/figure/spring_bones.h"
#include "avatar/mind/storyteller_io.h"
#include "base/rng.h"

namespace wellspring::avatar {

// Decides what the storyteller is doing: idle -> noticing -> greeting -> attending (or telling) ->
// farewell -> idle. Time is an argument. Detectors flicker: a person is somebody seen for 0.25 s,
// lost after 2 s, and the same one if another number appears at the same place.

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
  double since = 0;  // time at which the mood began
  double last_motion = -1e30;
  double last_company = -1e30;  // time at which a kiosk guest was last seen
  double last_greeting = -1e30;
  uint64_t visit = 0;      // number of the people's visit
  bool company = false;    // somebody was greeted and not yet bid farewell
  uint64_t addressed = 0;  // number of the guest greeted last
};

inline constexpr double confirm_seconds = 0.25, lost_seconds = 2.0, greeting_seconds = 3.0,
                        farewell_seconds = 3.0;

// Overwrites `events`. `now` must not run backwards.
void decide(BehaviourState& state, const StorytellerInput& input, double now,
            StorytellerEvents& events);

// A visitor's camera is looked at within the first of these distances, metres; while the visitor
// listens to a story, within the second.
inline constexpr float remote_radius = 8, listener_radius = 20;
// The head turns at most so far away from a listener, whatever else is looked at.
inline constexpr float most_away = 60_deg;

struct GazeState {
  bool begun = false;
  bool at_guest = false;
  uint64_t guest = 0;
  bool kiosk_known = false;
  vec3 kiosk_place{0};  // eyes of the last kiosk guest, humanoid space
  // time at which a glance ends: remote guests are not stared at without end
  double glance_until = 0;
  bool glancing_away = false;
  double wander_until = 0;
  vec3 wander{0, 0, 4};  // yaw, pitch, distance while looking at nobody
  double next_saccade = 0;
  vec2 saccade{0};                         // small step of the eyes around the target
  vec3 target{0, 1.6f, 4};                 // place looked at, humanoid space
  std::optional<vec3> listener;            // head of the guest who is not to be shown a back
  float turn = 0;                          // angle from the body's facing to the target, radians
  Spring yaw, pitch, nearness{0.25f, 0};   // line of sight of the eyes; nearness = 1 / distance
  Spring head_yaw, head_pitch, torso_yaw;  // torso_yaw: relative to the heading
};

struct GazeInput {
  std::span<const Guest> guests;  // with their heads in humanoid space
  std::optional<vec3> look;       // place that the story wants looked at instead, humanoid space
  float heading = 0;              // facing of the body, radians
  bool kiosk_motion = false, humanlike = true;
  bool saccades = true;  // false: nobody is near enough to see them
};

// Eyes, head and chest have made nine tenths of a turn after these times (3.9 / rate of their
// springs).
inline constexpr float eye_seconds = 0.14f, head_seconds = 0.65f, torso_seconds = 1.56f;

// Advances the gaze by a tick. Returns true when it has made a large jump (the eyes like to blink
// then).
bool tick_gaze(GazeState& state, const Rig& rig, const BehaviourState& behaviour,
               const GazeInput& input, Rng& rng, double now, float dt);

// Returns the way round by `turn` from the body's facing: to the left up to 170 degrees, beyond it
// over the right, as the right hand points to places straight behind. A way of `before` that is far
// round stays on its side.
float way_round(float turn, float before = 0);
// Returns the middle between the eyes while the body faces `heading`, standing still.
vec3 eyes_origin(const Rig& rig, float heading);
// Returns the point the eyes converge on.
vec3 gaze_point(const GazeState& state, const Rig& rig, float heading);

}  // namespace wellspring::avatar
