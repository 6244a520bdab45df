// SPDX-License-Identifier: Apache-2.0
// The storyteller's mind and body, tick by tick: whom it notices, what it says, how it stands.
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

// The figure and where it stands; what never changes while an exhibit runs.
struct Storyteller {
  const Character* character = nullptr;  // borrowed
  mat4 placement{1};                     // humanoid space to world
  // Borrowed; null: what comes with the program.
  const GestureLibrary* gestures = nullptr;
  const ExpressionSet* expressions = nullptr;
};

// Everything remembered from tick to tick, a plain value: copy it and the copy goes on alike.
struct StorytellerState {
  Mood mood = Mood::idle;
  double clock = 0;  // sum of all dt
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
  std::array<Spring, 3> point;  // what hands point at, humanoid space, gliding from place to place
  std::shared_ptr<const Rig> rig;                    // of the character last seen; immutable
  std::shared_ptr<const ExpressionRig> expressions;  // of that rig and set; immutable
};

// One tick: notices, decides, moves. Overwrites `pose` and `events`. Never fails.
void tick_storyteller(StorytellerState& state, const Storyteller& storyteller,
                      const StorytellerInput& input, Pose& pose, StorytellerEvents& events);

// Where its hand holds what `state.hold` says: from the fist's frame (avatar/body/hold.h) to the
// world, as posed now. Nothing while nothing is held, or for a figure without that hand.
std::optional<mat4> eval_grip(const StorytellerState& state, const Storyteller& storyteller,
                              const Pose& pose);

// Where its voice comes from as posed now, world coordinates.
vec3 eval_mouth(const StorytellerState& state, const Storyteller& storyteller, const Pose& pose);

// Where the storyteller looks, for messages and measurements.
struct StorytellerGaze {
  vec3 target{0};            // world: what it wants to look at
  float yaw = 0, pitch = 0;  // of its line of sight as posed now, from the way the placement faces;
                             // radians, yaw positive to its own left, pitch positive up
  uint64_t guest = 0;        // whom it looks at; 0: nobody
};
StorytellerGaze eval_gaze(const StorytellerState& state, const Storyteller& storyteller,
                          const Pose& pose);

}  // namespace wellspring::avatar
