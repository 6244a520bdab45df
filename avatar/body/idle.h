// SPDX-License-Identifier: Apache-2.0
// What a standing person does without meaning to: breathes, sways, shifts the weight, moves the
// hands a little.
#pragma once
#include "avatar/figure/spring.h"
#include "base/rng.h"
#include "base/vec.h"

namespace wellspring::avatar {

struct IdleState {
  double breath = 0;  // cycles, 0..1
  Spring side;        // weight on the left (1) or right (-1) leg
  float side_wanted = 0;
  double next_shift = 6;
  Spring fold;  // hands folded before the body (1) or hanging (0)
  float fold_wanted = 0;
};

// Offsets to be added, radians and metres.
struct IdleMotion {
  float breath = 0;     // chest filled, 0..1
  vec3 pelvis{0};       // humanoid space
  vec3 pelvis_turn{0};  // yaw, pitch, roll
  vec3 torso_turn{0}, head_turn{0};
  vec3 arm[2] = {vec3(0), vec3(0)};  // forward, side, elbow
  float curl[2] = {0, 0};
};

// `lively` 0..1 quickens the breath; `hands_busy` unfolds the hands.
IdleMotion tick_idle(IdleState& state, Rng& rng, float lively, bool hands_busy, bool humanlike,
                     double now, float dt);

}  // namespace wellspring::avatar
