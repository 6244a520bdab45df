// SPDX-License-Identifier: Apache-2.0
// Finds where the body faces and where its feet stand. A turn is made in steps, one foot at a time;
// a foot that does not step does not move.
#pragma once
#include <array>

#include "avatar/figure/spring_bones.h"
#include "base/rng.h"
#include "base/vec.h"

namespace wellspring::avatar {

struct Foot {
  float from = 0, to = 0;  // facing before and after the step, radians about +Y
  float phase = 1;         // 0..1 through the step; 1: planted
  float facing() const { return from + (to - from) * smooth_step(0, 1, phase); }
  float lift() const;  // metres
};

struct StanceState {
  std::array<Foot, 2> foot;  // left, right
  Spring heading;            // facing of the pelvis, radians about +Y
  Spring lean;  // weight towards the standing foot while the other steps, metres to its left
  float wanted = 0;
  double turned_away = -1e30;  // time since the aim has been far to the side, s; < 0: it is not
};

// Advances by dt. `aim` is the yaw of the place that is looked at; once it has been farther than
// `reach` from the heading for `patience` seconds, the body turns to it. reach < 0: nobody is
// looked at, and the body turns back to the front after `patience`. Without legs it just turns.
void tick_stance(StanceState& state, bool has_legs, float aim, float reach, float patience,
                 double now, float dt);

// Moves a standing person as it moves without meaning to: it breathes, sways, shifts the weight,
// moves the hands a little.

struct IdleState {
  double breath = 0;  // cycles, 0..1
  Spring side;        // weight on the left (1) or right (-1) leg
  float side_wanted = 0;
  double next_shift = 6;
  Spring fold;  // hands folded before the body (1) or hanging (0)
  float fold_wanted = 0;
};

// Holds offsets to be added, radians and metres.
struct IdleMotion {
  float breath = 0;     // share to which the chest is filled, 0..1
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
