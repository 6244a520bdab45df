// SPDX-License-Identifier: Apache-2.0
// Arms by a few meaningful angles, and short clips made of them. The same angles fit every figure:
// the rig knows how its arms hang.
#pragma once
#include <array>
#include <cstdint>

#include "avatar/spring.h"

namespace wellspring {

// One arm; radians. All zero: it hangs straight down, palm to the thigh.
struct ArmPose {
  float forward = 0, side = 0;  // upper arm raised to the front, away from the body
  float turn = 0;               // upper arm about itself: the bent forearm swings inwards
  float elbow = 0;              // bent
  float pronate = 0;         // palm from inwards to backwards (or down, when the forearm is level)
  float flex = 0, tilt = 0;  // wrist towards the palm, towards the thumb
  float curl = 0;            // fingers, mean of their joints
};
ArmPose mix(const ArmPose& a, const ArmPose& b, float t);

enum class Gesture : uint8_t { none, welcome, wave, nod };

struct GestureState {
  Gesture gesture = Gesture::none;
  float time = 0;
  double next_nod = 0;
};

struct GestureMotion {
  std::array<ArmPose, 2> arm;         // left, right
  std::array<float, 2> weight{0, 0};  // of them over the resting arms
  float nod = 0;                      // head, down positive, radians
  float bow = 0;                      // chest and hips forward, radians
};

void start_gesture(GestureState& state, Gesture gesture);
// Advances the running clip; afterwards there is none.
GestureMotion tick_gesture(GestureState& state, float dt);

// Arms at rest: hanging, and hands folded in front of the body. `spread` is the figure's own.
ArmPose hanging_arm(float spread);
ArmPose folded_arm(int side);

}  // namespace wellspring
