// SPDX-License-Identifier: Apache-2.0
#include "avatar/body/body.h"

#include <algorithm>
#include <cmath>

#include "avatar/body/point_at.h"
#include "avatar/figure/joint_limits.h"

namespace wellspring::avatar {
namespace {

quat about_x(float a) { return glm::angleAxis(a, vec3(1, 0, 0)); }
quat about_y(float a) { return glm::angleAxis(a, vec3(0, 1, 0)); }
quat about_z(float a) { return glm::angleAxis(a, vec3(0, 0, 1)); }

// Turns a chain from the frame below it so that its last joint has the rotation `wanted` (humanoid
// space); each link takes its share of the same turn.
void bend_chain(const Rig& rig, const std::vector<WeightedJoint>& chain, quat below, quat wanted,
                Pose& pose) {
  if (chain.empty()) return;
  const std::vector<Joint>& joints = rig.character->joints;
  quat turn = glm::conjugate(below) * wanted;
  if (turn.w < 0) turn = -turn;
  float half = std::atan2(glm::length(vec3(turn.x, turn.y, turn.z)), turn.w);
  vec3 axis = half > 1e-6f ? glm::normalize(vec3(turn.x, turn.y, turn.z)) : vec3(0, 1, 0);
  bool limited = false;
  for (const WeightedJoint& link : chain) {
    pose.rotations[size_t(link.joint)] = glm::angleAxis(2 * half * link.share, axis);
    limited |= has_limits(joints[size_t(link.joint)]);
  }
  // What one joint may not do the others do as far as they may.
  for (int round = 0; limited && round < 6; round++) {
    quat reached = below;
    float free = 0;
    for (const WeightedJoint& link : chain) {
      quat& own = pose.rotations[size_t(link.joint)];
      quat kept = limit_turn(joints[size_t(link.joint)], own);
      if (kept == own) free += link.share;
      own = kept;
      reached = reached * own;
    }
    quat rest = glm::conjugate(reached) * wanted;
    if (rest.w < 0) rest = -rest;
    if (rest.w > 0.999999f || free < 1e-3f || round == 5) break;
    for (const WeightedJoint& link : chain) {
      quat& own = pose.rotations[size_t(link.joint)];
      own = own * glm::slerp(quat(1, 0, 0, 0), rest, std::min(link.share / free, 1.0f));
    }
  }
  for (const WeightedJoint& link : chain)
    if (limited) {
      quat& own = pose.rotations[size_t(link.joint)];
      own = limit_turn(joints[size_t(link.joint)], own);
    }
}

quat parent_rotation(const Rig& rig, const Pose& pose, int joint) {
  int parent = rig.character->joints[size_t(joint)].parent;
  return parent < 0 ? quat(1, 0, 0, 0) : eval_joint_frame(*rig.character, pose, parent).rotation;
}

void pose_arm(const Rig& rig, int side, const ArmPose& arm, float shoulders_up, bool fingers,
              Pose& pose) {
  const ArmRig& bones = rig.arm[size_t(side)];
  float s = side == 0 ? 1.0f : -1.0f;
  if (bones.collar >= 0) {
    float raised = std::max(arm.side, 0.6f * arm.forward);
    pose.rotations[size_t(bones.collar)] =
        about_z(s * (shoulders_up + 0.12f * std::max(raised - 0.6f, 0.0f)));
  }
  if (bones.shoulder < 0 || bones.elbow < 0) return;
  quat shoulder = about_z(s * arm.side) * about_x(-arm.forward) * about_y(-s * arm.turn);
  quat elbow = about_x(-arm.elbow) * about_y(-s * 0.6f * arm.pronate);
  quat wrist = about_y(-s * 0.4f * arm.pronate) * about_z(-s * arm.flex) * about_x(-arm.tilt);
  pose.rotations[size_t(bones.shoulder)] = shoulder * bones.upper_hangs;
  pose.rotations[size_t(bones.elbow)] =
      glm::conjugate(bones.upper_hangs) * elbow * bones.fore_hangs;
  if (bones.wrist >= 0)
    pose.rotations[size_t(bones.wrist)] =
        glm::conjugate(bones.fore_hangs) * wrist * bones.hand_hangs;
  if (!fingers) return;
  for (const FingerJoint& finger : bones.fingers) {
    // Relaxed fingers bend more towards the little one and less at the tips.
    constexpr float share[3] = {0.8f, 1.35f, 0.85f};
    if (finger.finger == 0) {
      constexpr float thumb_share[3] = {0.25f, 0.45f, 0.55f};
      float turn = (arm.curl + arm.finger[0]) * thumb_share[finger.knuckle];
      pose.rotations[size_t(finger.joint)] = glm::angleAxis(std::max(turn, -0.25f), finger.axis);
      continue;
    }
    float wanted = (arm.curl + arm.finger[size_t(finger.finger)]) * share[finger.knuckle] *
                   (0.75f + 0.13f * float(finger.finger));
    float turn = std::max(wanted - finger.bent, -0.15f);
    pose.rotations[size_t(finger.joint)] = glm::angleAxis(turn, finger.axis);
  }
}

void keep_limits(const Rig& rig, int joint, Pose& pose) {
  if (joint < 0) return;
  quat& turn = pose.rotations[size_t(joint)];
  turn = limit_turn(rig.character->joints[size_t(joint)], turn);
}

void keep_arm_limits(const Rig& rig, int side, Pose& pose) {
  const ArmRig& bones = rig.arm[size_t(side)];
  for (int joint : {bones.collar, bones.shoulder, bones.elbow, bones.wrist})
    keep_limits(rig, joint, pose);
  for (const FingerJoint& finger : bones.fingers) keep_limits(rig, finger.joint, pose);
}

mat3 limb_frame(vec3 along, vec3 pole) {
  vec3 side = cross(pole, along);
  float length = glm::length(side);
  side = length > 1e-5f ? side / length : vec3(1, 0, 0);
  return mat3(side, along, cross(side, along));
}

// Two bones from the posed hip to the planted ankle.
void pose_leg(const Rig& rig, int side, const FootPlan& foot, Pose& pose) {
  const LegRig& leg = rig.leg[size_t(side)];
  const Character& character = *rig.character;
  vec3 hip0 = character.joints[size_t(leg.hip)].center,
       knee0 = character.joints[size_t(leg.knee)].center;
  vec3 ankle0 = character.joints[size_t(leg.ankle)].center;
  vec3 axis = character.joints[size_t(rig.root)].center;
  axis.y = 0;
  quat facing = about_y(foot.facing);
  vec3 ankle = axis + facing * (ankle0 - axis) + vec3(0, foot.lift, 0);
  pose.rotations[size_t(leg.hip)] = quat(1, 0, 0, 0);
  JointFrame hip = eval_joint_frame(character, pose, leg.hip);
  float a = glm::length(knee0 - hip0), b = glm::length(ankle0 - knee0);
  vec3 way = ankle - hip.center;
  float d = std::clamp(glm::length(way), std::abs(a - b) + 1e-3f, (a + b) * 0.99995f);
  vec3 along = glm::normalize(way);
  float forward = (a * a - b * b + d * d) / (2 * d);
  vec3 pole = facing * leg.pole;
  pole = glm::normalize(pole - along * dot(pole, along));
  vec3 knee =
      hip.center + along * forward + pole * std::sqrt(std::max(a * a - forward * forward, 0.0f));
  vec3 end = hip.center + along * d;
  auto turn = [&](vec3 from, vec3 to) {
    mat3 m = limb_frame(glm::normalize(to), facing * leg.pole) *
             glm::transpose(limb_frame(glm::normalize(from), leg.pole));
    return glm::normalize(glm::quat_cast(m));
  };
  quat thigh = turn(knee0 - hip0, knee - hip.center), shin = turn(ankle0 - knee0, end - knee);
  pose.rotations[size_t(leg.hip)] = glm::conjugate(hip.rotation) * thigh;
  pose.rotations[size_t(leg.knee)] = glm::conjugate(thigh) * shin;
  // The toes hang a little while the foot is up.
  pose.rotations[size_t(leg.ankle)] = glm::conjugate(shin) * facing * about_x(4 * foot.lift);
}

// How far to turn where `angle`, from 0, is wanted and nobody said more than `limit`.
float in_range(const EyeRange& range, float angle, float limit) {
  return range.most > 0 ? std::min(angle / range.most, 1.0f) * range.output
                        : std::min(angle, limit);
}

// Each eye points at the same place.
void pose_eye(const Rig& rig, int side, vec3 point, Pose& pose) {
  int joint = rig.eye[size_t(side)];
  pose.rotations[size_t(joint)] = quat(1, 0, 0, 0);
  JointFrame eye = eval_joint_frame(*rig.character, pose, joint);
  vec3 way = glm::conjugate(eye.rotation) * (point - eye.center);
  if (dot(way, way) < 1e-6f) return;
  float yaw = std::atan2(way.x, way.z), pitch = std::atan2(way.y, glm::length(vec2(way.x, way.z)));
  const EyeRanges& ranges = rig.character->eye_ranges;
  const EyeRange& aside = (side == 0) == (yaw < 0) ? ranges.inner : ranges.outer;
  yaw = std::copysign(in_range(aside, std::abs(yaw), eye_limit_yaw), yaw);
  pitch = pitch > 0 ? in_range(ranges.up, pitch, eye_limit_up)
                    : -in_range(ranges.down, -pitch, eye_limit_down);
  pose.rotations[size_t(joint)] = about_y(yaw) * about_x(-pitch);
  keep_limits(rig, joint, pose);
}

// Eyes drawn on the face look by shapes.
void pose_drawn_eyes(const Rig& rig, vec3 point, Pose& pose) {
  int joint = rig.skull >= 0 ? rig.skull : rig.root;
  JointFrame head = eval_joint_frame(*rig.character, pose, joint);
  vec3 eyes =
      head.center + head.rotation * (rig.eyes_center - rig.character->joints[size_t(joint)].center);
  vec3 way = glm::conjugate(head.rotation) * (point - eyes);
  if (dot(way, way) < 1e-6f) return;
  float yaw = std::atan2(way.x, way.z), pitch = std::atan2(way.y, glm::length(vec2(way.x, way.z)));
  const EyeRanges& ranges = rig.character->eye_ranges;
  const EyeRange aside = ranges.by_shapes ? ranges.outer : EyeRange(),
                 up = ranges.by_shapes ? ranges.up : EyeRange(),
                 down = ranges.by_shapes ? ranges.down : EyeRange();
  auto weight = [](EyeRange range, float angle, float limit) {
    if (!(range.most > 0)) range = {limit, 1};
    return std::clamp(in_range(range, angle, limit), 0.0f, 1.0f);
  };
  float wanted[4] = {weight(up, pitch, eye_limit_up), weight(down, -pitch, eye_limit_down),
                     weight(aside, yaw, eye_limit_yaw), weight(aside, -yaw, eye_limit_yaw)};
  for (size_t i = 0; i < 4; i++)
    if (rig.look[i] >= 0) pose.displacers[size_t(rig.look[i])] = wanted[i];
}

}  // namespace

void eval_body(const Rig& rig, const BodyPlan& plan, Pose& pose) {
  quat heading = about_y(plan.heading);
  quat pelvis = heading * about_y(plan.pelvis_turn.x) * about_x(plan.pelvis_turn.y) *
                about_z(plan.pelvis_turn.z);
  bool legs = rig.leg[0].complete() && rig.leg[1].complete();
  pose.translation = heading * plan.pelvis;
  if (!legs)
    pose.translation = vec3(0), pelvis = heading;  // nothing to hold the feet in their place
  pose.rotations[size_t(rig.root)] = pelvis;

  quat chest = heading * about_y(plan.torso.x) * about_x(plan.torso.y) * about_z(plan.torso.z);
  if (!rig.spine.empty())
    bend_chain(rig, rig.spine, parent_rotation(rig, pose, rig.spine[0].joint), chest, pose);
  if (!rig.neck.empty()) {
    quat head = about_y(plan.head.x) * about_x(-plan.head.y) * about_z(plan.head.z);
    bend_chain(rig, rig.neck, parent_rotation(rig, pose, rig.neck[0].joint), head, pose);
  }
  for (int side = 0; side < 2; side++) {
    size_t s = size_t(side);
    pose_arm(rig, side, plan.arm[s], plan.shoulders_up, plan.fingers, pose);
    keep_arm_limits(rig, side, pose);
    if (plan.finger_aim[s] > 0)
      point_arm(rig, side, Aim::finger, plan.point, plan.finger_aim[s], pose);
    if (plan.palm_aim[s] > 0) point_arm(rig, side, Aim::palm, plan.point, plan.palm_aim[s], pose);
    if (legs) pose_leg(rig, side, plan.foot[size_t(side)], pose);
  }
}

void aim_eyes(const Rig& rig, vec3 gaze_point, Pose& pose) {
  bool shapes = rig.character->eye_ranges.by_shapes && rig.look[2] >= 0 && rig.look[3] >= 0;
  if (!rig.eyes_move || shapes) return pose_drawn_eyes(rig, gaze_point, pose);
  for (int side = 0; side < 2; side++) pose_eye(rig, side, gaze_point, pose);
}

}  // namespace wellspring::avatar
