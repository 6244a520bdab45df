// SPDX-License-Identifier: Apache-2.0
// From intentions to joints: where pelvis, chest, head, eyes, arms and feet shall be -> a Pose. No
// state, no randomness. A figure without some joints moves the others.
#pragma once
#include <array>

#include "avatar/body/gesture.h"
#include "avatar/figure/pose.h"
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
  vec3 pelvis_turn{0};  // over the heading
  vec3 torso{0};        // of the chest, over the heading
  vec3 head{0};         // of the head, humanoid space (not over the heading); pitch positive up
  vec3 gaze_point{0, 1.6f, 4};
  std::array<ArmPose, 2> arm;
  vec3 point{0, 1.2f, 4};                                 // what arms point at, humanoid space
  std::array<float, 2> finger_aim{0, 0}, palm_aim{0, 0};  // how far they do, 0..1
  bool fingers = true;                                    // false: they stay as they are drawn
  float shoulders_up = 0;                                 // collar bones, radians
  std::array<FootPlan, 2> foot;
};

// Overwrites pose.translation and the rotations of the joints it moves: all but eyes and face.
void eval_body(const Rig& rig, const BodyPlan& plan, Pose& pose);
// Turns both eyes to the gaze point from wherever the head is by now.
void aim_eyes(const Rig& rig, vec3 gaze_point, Pose& pose);

// Largest turns of an eye in its socket.
inline constexpr float eye_limit_yaw = 0.62f, eye_limit_up = 0.45f, eye_limit_down = 0.55f;

}  // namespace wellspring::avatar
