// SPDX-License-Identifier: Apache-2.0
// Pointing: the arm of a gesture is swung at the shoulder (and bent at the elbow for what is close)
// until finger or hand lie on the line to a place. The swing is the smallest one from the gesture's
// own arm, as people do it (Donders' law for pointing: one arm orientation for each direction;
// Hore, Watts, Vilis 1992).
#pragma once
#include "avatar/body/gesture_library.h"
#include "avatar/figure/pose.h"
#include "avatar/figure/rig.h"

namespace wellspring::avatar {

// How far the upper arm swings before the chest, from straight ahead: across the body and outwards;
// and up and down. Radians.
inline constexpr float arm_across = 0.7f, arm_outward = 2.0f, arm_up = 1.4f, arm_down = 1.5f;

// The line that points, as posed: from the knuckle along the forefinger, or from the wrist along
// the hand. Figures without fingers or hands point with what they have.
struct PointingLine {
  vec3 from{0}, direction{0, -1, 0};  // humanoid space, unit length
};
PointingLine eval_pointing_line(const Rig& rig, const Pose& pose, int side, Aim with);

// Turns the arm that `pose` holds (posed as by the gesture) at `target`, by `weight` of the way;
// joint limits rule. Returns the angle that is left between line and target, at full weight.
// Targets within the arm (nearer than about 0.3 m to the shoulder) are not pointed at: the answer
// is pi.
float point_arm(const Rig& rig, int side, Aim with, vec3 target, float weight, Pose& pose);

}  // namespace wellspring::avatar
