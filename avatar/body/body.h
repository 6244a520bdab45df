// SPDX-License-Identifier: Apache-2.0
// Turns intentions into joints: where pelvis, chest, head, eyes, arms and feet shall be -> a Pose.
// It has no state and no randomness. A figure without some joints moves the others.
#pragma once
#include <array>

#include "avatar/body/gesture.h"
#include "avatar/figure/rig.h"

namespace wellspring::avatar {

struct FootPlan {
  float facing = 0;  // radians about +Y
  float lift = 0;    // metres
};

// Turns are (yaw, pitch, roll): about +Y to its own left, then down about X, then about Z. Radians.
struct BodyPlan {
  float heading = 0;
  vec3 pelvis{0};       // offset, humanoid space
  vec3 pelvis_turn{0};  // turn over the heading
  vec3 torso{0};        // turn of the chest, over the heading
  vec3 head{0};  // turn of the head, humanoid space (not over the heading); pitch positive up
  vec3 gaze_point{0, 1.6f, 4};
  std::array<ArmPose, 2> arm;
  vec3 point{0, 1.2f, 4};  // place that arms point at, humanoid space
  std::array<float, 2> finger_aim{0, 0}, palm_aim{0, 0};  // shares of pointing, 0..1
  bool fingers = true;                                    // false: fingers stay as they are drawn
  float shoulders_up = 0;                                 // rise of the collar bones, radians
  std::array<FootPlan, 2> foot;
};

// Overwrites pose.translation and the rotations of the joints it moves: all but eyes and face.
void eval_body(const Rig& rig, const BodyPlan& plan, Pose& pose);
// Turns both eyes to the gaze point from wherever the head is by now.
void aim_eyes(const Rig& rig, vec3 gaze_point, Pose& pose);

// An eye turns in its socket by at most these angles, radians.
inline constexpr float eye_limit_yaw = 0.62f, eye_limit_up = 0.45f, eye_limit_down = 0.55f;

// Points at places: the arm of a gesture is swung at the shoulder (and bent at the elbow for what
// is close) until finger or hand lie on the line to a place. The swing is the smallest one from the
// gesture's own arm, as people do it (Donders' law for pointing: one arm orientation for each
// direction; Hore, Watts, Vilis 1992).

// The upper arm swings at most so far before the chest, from straight ahead: across the body and
// outwards; and up and down. Radians.
inline constexpr float arm_across = 0.7f, arm_outward = 2.0f, arm_up = 1.4f, arm_down = 1.5f;

// Holds the line that points, as posed: from the knuckle along the forefinger, or from the wrist
// along the hand. Figures without fingers or hands point with what they have.
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
