// SPDX-License-Identifier: Apache-2.0
// Arms, head and chest by a few meaningful angles. The same angles fit every figure: the rig knows
// how its arms hang. A gesture is a clip of them; clips pass over into each other without a jump of
// place or speed (inertial blending: what the broken-off motion leaves is a spring that comes to
// rest).
#pragma once
#include <array>
#include <cstdint>

#include "avatar/body/gesture_library.h"
#include "avatar/figure/spring.h"

namespace wellspring::avatar {

// What is asked of the arms in one tick.
struct GestureOrder {
  int clip = -1;      // begins now; -1: nothing new
  float size = 1;     // 0..1: how large the clip is played
  float lead = 0;     // seconds until its stroke is due; < 0: as the clip has it
  float seconds = 0;  // how long it shall last; longer than the clip: its held moment is drawn out
  bool mirrored = false;  // left for right
};

struct GestureState {
  int clip = -1;
  float time = 0;            // since the clip began; negative: it waits for its word
  float size = 1, hold = 0;  // hold: seconds added to the held moment
  bool mirrored = false;
  std::array<float, 2> free{1, 1};  // as last told
  // What earlier motions left, one spring a channel of GestureMotion; at rest when `blending` is
  // false.
  std::array<Spring, gesture_channels> left_over;
  bool blending = false;
};

// Advances the running clip by dt after taking `order`. `rest` are the arms without any gesture,
// `free` says how far each may leave it, 0..1. The arms of the answer are final, `weight` says how
// much of them is gesture, 0..1.
GestureMotion tick_gesture(GestureState& state, const GestureLibrary& library,
                           const GestureOrder& order, const std::array<ArmPose, 2>& rest, float dt,
                           const std::array<float, 2>& free = {1, 1});

// Left for right.
void swap_sides(GestureMotion& motion);
ArmPose mix(const ArmPose& a, const ArmPose& b, float t);
// Within what human arms can do (American Academy of Orthopaedic Surgeons' normal ranges).
ArmPose limit_arm(const ArmPose& arm);

// Arms at rest: hanging, and hands folded in front of the body. `spread` is the figure's own.
ArmPose hanging_arm(float spread);
ArmPose folded_arm(int side);

}  // namespace wellspring::avatar
