// SPDX-License-Identifier: Apache-2.0
// Runs the storyteller's mind and body, tick by tick: whom it notices, what it says, how it stands.
// State is a value; time is an argument, so a test can run hours in a moment and a replay is
// bit-identical. Source: the storyteller and kiosk paper (agent's two layers, lazy mirror, farewell
// override).
#pragma once
#include <memory>
#include <vector>

#include "avatar/body/gesture.h"
#include "avatar/body/hold.h"
#include "avatar/body/stance.h"
#include "avatar/face/face.h"
#include "avatar/figure/spring_bones.h"
#include "avatar/mind/body_language.h"
#include "avatar/mind/gaze.h"
#include "avatar/mind/storyteller_io.h"

namespace wellspring::avatar {

// Holds the figure and its placement, which never change while an exhibit runs.
struct Storyteller {
  const Character* character = nullptr;  // borrowed
  mat4 placement{1};                     // humanoid space to world
  // Borrowed; null: the program's own.
  const GestureLibrary* gestures = nullptr;
  const ExpressionSet* expressions = nullptr;
};

// Holds everything that is remembered from tick to tick, a plain value: a copy goes on alike.
struct StorytellerState {
  Mood mood = Mood::idle;
  double clock = 0;  // seconds, sum of all dt
  Rng rng{20240229};
  BehaviourState behaviour;
  GazeState gaze;
  MirrorState mirror;
  BlinkState blink;
  IdleState idle;
  GestureState gesture;
  HoldState hold;
  BodyLanguageState body_language;
  StanceState stance;
  BowState bow;
  FaceState face;
  SpringBonesState springs;
  Detail detail = Detail::full;
  StorytellerWork work;
  // place that hands point at, humanoid space, gliding from one to the next
  std::array<Spring, 3> point;
  std::shared_ptr<const Rig> rig;                    // rig of the last character, immutable
  std::shared_ptr<const ExpressionRig> expressions;  // made for that rig and set, immutable
};

// Advances by one tick: notices, decides, moves. Overwrites `pose` and `events`. Never fails.
void tick_storyteller(StorytellerState& state, const Storyteller& storyteller,
                      const StorytellerInput& input, Pose& pose, StorytellerEvents& events);

// Returns the transform of the hand that holds `state.hold`: from the fist's frame
// (avatar/body/hold.h) to the world, as posed now. Returns nothing if nothing is held, or for a
// figure without that hand.
std::optional<mat4> eval_grip(const StorytellerState& state, const Storyteller& storyteller,
                              const Pose& pose);

// Returns the place its voice comes from as posed now, world coordinates.
vec3 eval_mouth(const StorytellerState& state, const Storyteller& storyteller, const Pose& pose);

// Holds where the storyteller looks, for messages and measurements.
struct StorytellerGaze {
  vec3 target{0};  // place it wants to look at, world
  // line of sight as posed now, from the placement's facing; radians, yaw positive to its own left,
  // pitch positive up
  float yaw = 0, pitch = 0;
  uint64_t guest = 0;  // guest it looks at; 0: nobody
};
StorytellerGaze eval_gaze(const StorytellerState& state, const Storyteller& storyteller,
                          const Pose& pose);

}  // namespace wellspring::avatar
