// SPDX-License-Identifier: Apache-2.0
#include "avatar/body/body.h"

#include <algorithm>
#include <cmath>

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
  // If one joint is limited, the others do its share as far as their limits allow.
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

// Poses two bones from the posed hip to the planted ankle.
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

// Returns how far to turn if `angle`, from 0, is wanted: by the figure's range, else up to `limit`.
float in_range(const EyeRange& range, float angle, float limit) {
  return range.most > 0 ? std::min(angle / range.most, 1.0f) * range.output
                        : std::min(angle, limit);
}

// Points one eye at `point`, which both eyes share.
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

// Makes eyes that are drawn on the face look, by shapes.
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
    // without legs nothing holds the feet in their place
    pose.translation = vec3(0), pelvis = heading;
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

// Moves a direction into the allowed part of the sphere of directions; `v` is in the chest's frame,
// outwards along +x.
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

// Brings each joint into the file's limits after a swing that did not know of them; what is missing
// to the target is done by joints that still may move, from the shoulder outwards (cyclic
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
        continue;  // an arm on its way is only kept within limits
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

  // The elbow bends until the hand ends before the target. The forearm's plane stays.
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
    // The hinge is in the frame of the elbow's own joint, which turns with the upper arm.
    vec3 hinge = glm::conjugate(posed.rotation) * glm::normalize(axis);
    elbow = glm::angleAxis((wanted - bent) * weight, hinge) * elbow;
    line = eval_pointing_line(rig, pose, side, with);
    fore = eval_joint_frame(character, pose, bones.elbow);
  }

  // The arm swings about the shoulder until the point of the line that is as far along as the
  // target lies on it.
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
  // Keeps the arm within the reach of the joint, as seen from the chest.
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
