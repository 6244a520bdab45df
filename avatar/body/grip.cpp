// SPDX-License-Identifier: Apache-2.0
#include "avatar/body/grip.h"

namespace wellspring::avatar {

std::optional<mat4> eval_grip(const Rig& rig, const Pose& pose, int side) {
  const ArmRig& arm = rig.arm[size_t(side)];
  if (arm.wrist < 0) return std::nullopt;
  const Character& character = *rig.character;
  // Of the hand at rest, which hangs with its palm inwards when turned by hand_hangs.
  const quat to_rest = glm::conjugate(arm.hand_hangs);
  const vec3 fingers = to_rest * vec3(0, -1, 0), thumb = to_rest * vec3(0, 0, 1);
  const vec3 palm = to_rest * vec3(side == 0 ? -1 : 1, 0, 0);
  const vec3 wrist = character.joints[size_t(arm.wrist)].center;
  vec3 knuckles(0);
  int count = 0;
  for (const FingerJoint& finger : arm.fingers)
    if (finger.finger > 0 && finger.knuckle == 0)
      knuckles += character.joints[size_t(finger.joint)].center, count++;
  constexpr float usual_palm = 0.085f;  // metres from the wrist to the knuckles
  knuckles = count > 0 ? knuckles / float(count) : wrist + usual_palm * fingers;
  // A rod lies in the bend of the fingers, before the palm.
  constexpr float before_palm = 0.30f, behind_knuckles = 0.06f;  // of the palm's length
  const float length = glm::length(knuckles - wrist);
  const vec3 place = knuckles + length * (before_palm * palm - behind_knuckles * fingers);

  const JointFrame frame = eval_joint_frame(character, pose, arm.wrist);
  const vec3 y = frame.rotation * thumb, z = frame.rotation * fingers;
  return mat4(vec4(cross(y, z), 0), vec4(y, 0), vec4(z, 0),
              vec4(frame.center + frame.rotation * (place - wrist), 1));
}

}  // namespace wellspring::avatar
