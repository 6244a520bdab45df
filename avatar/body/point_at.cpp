// SPDX-License-Identifier: Apache-2.0
#include "avatar/body/point_at.h"

#include <algorithm>
#include <cmath>

#include "avatar/figure/joint_limits.h"

namespace wellspring::avatar {
namespace {

quat between(vec3 from, vec3 to) {
  float c = dot(from, to);
  if (c < -0.99999f) return glm::angleAxis(pi, vec3(0, 1, 0));
  return glm::normalize(quat(1 + c, cross(from, to)));
}

float angle_of(vec3 a, vec3 b) { return std::atan2(glm::length(cross(a, b)), dot(a, b)); }

int knuckle_of(const ArmRig& bones, int finger, int knuckle) {
  for (const FingerJoint& joint : bones.fingers)
    if (joint.finger == finger && joint.knuckle == knuckle) return joint.joint;
  return -1;
}

// Towards the allowed part of the sphere of directions; `v` in the chest's frame, outwards along
// +x.
vec3 limited(vec3 v) {
  float up = std::asin(std::clamp(v.y, -1.0f, 1.0f)), flat = glm::length(vec2(v.x, v.z));
  float out = flat > 1e-4f ? std::atan2(v.x, v.z) : 0;
  // An arm that hangs may hang anywhere; the higher it is, the more the chest is in its way.
  float open = std::clamp((-up - 0.8f) / 0.5f, 0.0f, 1.0f) * pi;
  // Behind the back the nearer end of the reach counts, round the circle.
  if (out < 0.5f * (arm_outward - arm_across) - pi) out += 2 * pi;
  out = std::clamp(out, -arm_across - open, arm_outward + open);
  up = std::clamp(up, -arm_down, arm_up);
  return {std::sin(out) * std::cos(up), std::sin(up), std::cos(out) * std::cos(up)};
}

// After a swing that did not know of the file's limits: each joint is brought into its own, and
// what is missing to the target is done by those that still may, from the shoulder outwards (cyclic
// coordinate descent). Returns the angle that is left.
float point_within_limits(const Rig& rig, int side, Aim with, vec3 target, float weight,
                          Pose& pose) {
  const ArmRig& bones = rig.arm[size_t(side)];
  const Character& character = *rig.character;
  float left = pi;
  for (int round = 0; round < 12; round++) {
    for (int joint : {bones.shoulder, bones.elbow, bones.wrist}) {
      if (joint < 0) continue;
      quat& turn = pose.rotations[size_t(joint)];
      turn = limit_turn(character.joints[size_t(joint)], turn);
      PointingLine line = eval_pointing_line(rig, pose, side, with);
      vec3 way = target - line.from;
      if (weight < 1 || dot(way, way) < 1e-6f)
        continue;  // on its way there: only kept within limits
      quat frame = eval_joint_frame(character, pose, joint).rotation;
      quat more = between(line.direction, glm::normalize(way));
      turn = limit_turn(character.joints[size_t(joint)],
                        glm::normalize(turn * (glm::conjugate(frame) * more * frame)));
    }
    PointingLine line = eval_pointing_line(rig, pose, side, with);
    left = angle_of(line.direction, target - line.from);
    if (weight < 1 || left < 1e-3f) break;
  }
  return left;
}

}  // namespace

PointingLine eval_pointing_line(const Rig& rig, const Pose& pose, int side, Aim with) {
  const ArmRig& bones = rig.arm[size_t(side)];
  const Character& character = *rig.character;
  auto at = [&](int joint) { return character.joints[size_t(joint)].center; };
  // A bone from one joint to another turns with the first.
  auto bone = [&](int from, int to) {
    JointFrame frame = eval_joint_frame(character, pose, from);
    vec3 along = at(to) - at(from);
    float length = glm::length(along);
    return PointingLine{frame.center,
                        length > 1e-5f ? frame.rotation * (along / length) : vec3(0, -1, 0)};
  };
  if (with == Aim::finger) {
    int knuckle = knuckle_of(bones, 1, 0), next = knuckle_of(bones, 1, 1);
    if (knuckle >= 0 && next >= 0) return bone(knuckle, next);
  }
  int middle = knuckle_of(bones, 2, 0);
  if (bones.wrist >= 0 && middle >= 0) return bone(bones.wrist, middle);
  if (bones.wrist >= 0) {
    PointingLine line = bone(bones.elbow, bones.wrist);
    line.from = eval_joint_frame(character, pose, bones.wrist).center;
    return line;
  }
  return bone(bones.shoulder, bones.elbow);
}

float point_arm(const Rig& rig, int side, Aim with, vec3 target, float weight, Pose& pose) {
  const ArmRig& bones = rig.arm[size_t(side)];
  if (bones.shoulder < 0 || bones.elbow < 0 || !is_finite(target) || with == Aim::none) return pi;
  const Character& character = *rig.character;
  quat& shoulder = pose.rotations[size_t(bones.shoulder)];
  quat& elbow = pose.rotations[size_t(bones.elbow)];
  JointFrame posed = eval_joint_frame(character, pose, bones.shoulder);
  vec3 center = posed.center;
  float distance = glm::length(target - center);
  if (distance < 0.3f) return pi;

  // Bend the elbow until the hand ends before the target. The forearm's plane stays.
  PointingLine line = eval_pointing_line(rig, pose, side, with);
  JointFrame fore = eval_joint_frame(character, pose, bones.elbow);
  float upper = glm::length(fore.center - center), rest = glm::length(line.from - fore.center);
  vec3 u = glm::normalize(fore.center - center), f = glm::normalize(line.from - fore.center);
  float bent = angle_of(u, f), wanted = bent;
  auto reach = [&](float angle) {  // from the elbow along the forearm to the target
    float s = upper * std::sin(angle);
    return std::sqrt(std::max(distance * distance - s * s, 0.0f)) - upper * std::cos(angle);
  };
  while (wanted < 2.3f && reach(wanted) < rest + 0.12f) wanted += 0.02f;
  vec3 axis = cross(u, f);
  if (wanted > bent && glm::length(axis) > 1e-3f) {
    // In the frame of the elbow's own joint, which turns with the upper arm.
    vec3 hinge = glm::conjugate(posed.rotation) * glm::normalize(axis);
    elbow = glm::angleAxis((wanted - bent) * weight, hinge) * elbow;
    line = eval_pointing_line(rig, pose, side, with);
    fore = eval_joint_frame(character, pose, bones.elbow);
  }

  // Swing about the shoulder: the point of the line that is as far along as the target goes to it.
  quat swing(1, 0, 0, 0);
  vec3 from = line.from - center, along = line.direction, goal = target - center;
  for (int i = 0; i < 24; i++) {
    vec3 ahead = from + along * glm::length(goal - from);
    quat more = between(glm::normalize(ahead), glm::normalize(goal));
    swing = glm::normalize(more * swing);
    from = more * from;
    along = more * along;
    if (angle_of(along, goal - from) < 1e-5f) break;
  }
  // Within the reach of the joint, as seen from the chest.
  int below = character.joints[size_t(bones.shoulder)].parent;
  if (bones.collar >= 0) below = character.joints[size_t(bones.collar)].parent;
  quat chest = below >= 0 ? eval_joint_frame(character, pose, below).rotation : quat(1, 0, 0, 0);
  vec3 mirror(side == 0 ? 1.0f : -1.0f, 1, 1);
  vec3 arm = glm::conjugate(chest) * (swing * glm::normalize(fore.center - center)) * mirror;
  vec3 allowed = limited(arm);
  if (dot(arm, allowed) < 1 - 1e-7f) {
    quat back = between(chest * (arm * mirror), chest * (allowed * mirror));
    swing = glm::normalize(back * swing);
    from = back * from;
    along = back * along;
  }
  int parent = character.joints[size_t(bones.shoulder)].parent;
  quat hangs_from =
      parent >= 0 ? eval_joint_frame(character, pose, parent).rotation : quat(1, 0, 0, 0);
  if (swing.w < 0) swing = -swing;
  quat part = glm::slerp(quat(1, 0, 0, 0), swing, std::clamp(weight, 0.0f, 1.0f));
  shoulder = glm::normalize(glm::conjugate(hangs_from) * part * hangs_from * shoulder);
  const int joints[3] = {bones.shoulder, bones.elbow, bones.wrist};
  bool limits = std::any_of(joints, joints + 3, [&](int joint) {
    return joint >= 0 && has_limits(character.joints[size_t(joint)]);
  });
  return limits ? point_within_limits(rig, side, with, target, weight, pose)
                : angle_of(along, goal - from);
}

}  // namespace wellspring::avatar
