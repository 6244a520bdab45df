// SPDX-License-Identifier: Apache-2.0
#include "avatar/figure/rig.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>

#include "avatar/figure/joint_limits.h"

namespace wellspring::avatar {

Pose make_rest_pose(const Character& character) {
  Pose pose;
  pose.rotations.assign(character.joints.size(), quat(1, 0, 0, 0));
  pose.displacers.assign(character.displacers.size(), 0);
  return pose;
}

void eval_joints(const Character& character, const Pose& pose, std::vector<mat4>& to_humanoid) {
  to_humanoid.resize(character.joints.size());
  for (size_t j = 0; j < character.joints.size(); j++) {
    const Joint& joint = character.joints[j];
    quat turn = j < pose.rotations.size() ? pose.rotations[j] : quat(1, 0, 0, 0);
    float length = glm::length(turn);
    turn = length > 1e-6f && length < 1e6f ? turn * (1 / length) : quat(1, 0, 0, 0);
    mat4 local = glm::mat4_cast(turn);
    if (j < pose.stretches.size()) local = local * mat4(pose.stretches[j]);
    vec3 place = joint.center;
    if (j < pose.translations.size() && is_finite(pose.translations[j]))
      place += pose.translations[j];
    local[3] = vec4(place - mat3(local) * joint.center, 1);  // turns about the centre
    if (joint.parent >= 0) to_humanoid[j] = to_humanoid[size_t(joint.parent)] * local;
    else
      to_humanoid[j] =
          is_finite(pose.translation) ? glm::translate(mat4(1), pose.translation) * local : local;
  }
}

JointFrame eval_joint_frame(const Character& character, const Pose& pose, int joint) {
  // The loop goes from the joint up to the root: p' = c + r (p - c).
  quat rotation(1, 0, 0, 0);
  vec3 place = character.joints[size_t(joint)].center;
  for (int j = joint; j >= 0; j = character.joints[size_t(j)].parent) {
    quat turn = pose.rotations[size_t(j)];
    vec3 center = character.joints[size_t(j)].center;
    place = center + turn * (place - center);
    if (size_t(j) < pose.translations.size()) place += pose.translations[size_t(j)];
    rotation = turn * rotation;
    if (character.joints[size_t(j)].parent < 0) place += pose.translation;
  }
  return {rotation, place};
}

namespace {

constexpr vec3 down{0, -1, 0};

vec3 unit(vec3 v, vec3 otherwise) {
  float length = glm::length(v);
  return length > 1e-5f ? v / length : otherwise;
}

// Returns the shortest turn from one unit vector to another; half turns go about `axis`.
quat turn_between(vec3 from, vec3 to, vec3 axis) {
  float c = dot(from, to);
  if (c < -0.9999f) return glm::angleAxis(pi, axis);
  return glm::normalize(quat(1 + c, cross(from, to)));
}

bool has_vertices(const Character& character, int joint) {
  if (joint < 0) return false;
  return std::any_of(character.weights.begin(), character.weights.end(),
                     [&](const JointWeight& w) { return w.joint == joint && w.weight > 0.3f; });
}

ArmRig make_arm(const Character& character, int side) {
  ArmRig arm;
  std::string prefix = side == 0 ? "l_" : "r_";
  float outward = side == 0 ? 1.0f : -1.0f;
  auto find = [&](const std::string& name) { return find_joint(character, prefix + name); };
  auto at = [&](int joint) { return character.joints[size_t(joint)].center; };
  arm.collar = find("sternoclavicular");
  if (arm.collar < 0) arm.collar = find("acromioclavicular");
  arm.shoulder = find("shoulder");
  arm.elbow = find("elbow");
  arm.wrist = find("radiocarpal");
  if (arm.shoulder < 0 || arm.elbow < 0) return arm;
  vec3 upper = unit(at(arm.elbow) - at(arm.shoulder), down);
  arm.spread = std::acos(std::clamp(dot(upper, down), -1.0f, 1.0f));
  arm.upper_hangs = turn_between(upper, down, vec3(0, 0, 1));
  arm.fore_hangs = arm.hand_hangs = arm.upper_hangs;
  if (arm.wrist < 0) return arm;
  vec3 fore = arm.upper_hangs * unit(at(arm.wrist) - at(arm.elbow), upper);
  arm.fore_hangs = turn_between(fore, down, vec3(1, 0, 0)) * arm.upper_hangs;
  arm.hand_hangs = arm.fore_hangs;

  const char* knuckles[3] = {"metacarpophalangeal_", "carpal_proximal_interphalangeal_",
                             "carpal_distal_interphalangeal_"};
  int base[5] = {-1, -1, -1, -1, -1};
  for (int f = 2; f <= 5; f++) base[f - 1] = find(knuckles[0] + std::to_string(f));
  int middle = base[2] >= 0 ? base[2] : base[1];
  if (middle < 0) return arm;
  vec3 hand = unit(at(middle) - at(arm.wrist), fore);
  arm.hand_hangs = turn_between(arm.fore_hangs * hand, down, vec3(1, 0, 0)) * arm.fore_hangs;
  if (base[1] < 0 || base[4] < 0) return arm;
  // The palm looks to where fingers close; across it run the knuckles from the little finger to the
  // index.
  vec3 across = unit(at(base[1]) - at(base[4]), vec3(0, 0, 1));
  vec3 palm = unit(cross(hand, across) * outward, vec3(-outward, 0, 0));
  arm.curl_axis = unit(cross(hand, palm), vec3(0, 0, -outward));
  vec3 hanging_palm = arm.hand_hangs * palm;
  float twist = std::atan2(-outward * hanging_palm.z, -outward * hanging_palm.x);
  arm.hand_hangs = glm::angleAxis(std::clamp(twist, -0.8f, 0.8f), vec3(0, 1, 0)) * arm.hand_hangs;

  for (int f = 2; f <= 5; f++) {
    vec3 before = at(arm.wrist);
    for (int k = 0; k < 3; k++) {
      int joint = find(knuckles[k] + std::to_string(f));
      if (joint < 0) break;
      int next = k < 2 ? find(knuckles[k + 1] + std::to_string(f)) : -1;
      vec3 bone = unit(at(joint) - before, down);
      vec3 ahead = next >= 0 ? unit(at(next) - at(joint), bone) : bone;
      float bent = std::asin(std::clamp(dot(cross(bone, ahead), arm.curl_axis), -1.0f, 1.0f));
      arm.fingers.push_back({joint, f - 1, k, bent, arm.curl_axis});
      before = at(joint);
    }
  }
  // The thumb closes across the palm, towards the root of the ring finger, before the other
  // fingers.
  const char* thumb[3] = {"carpometacarpal_1", "metacarpophalangeal_1", "carpal_interphalangeal_1"};
  vec3 root = base[3] >= 0 ? at(base[3]) : at(middle);
  vec3 goal = root + palm * (0.3f * glm::length(at(middle) - at(arm.wrist)));
  for (int k = 0; k < 3; k++) {
    int joint = find(thumb[k]), next = k < 2 ? find(thumb[k + 1]) : -1;
    if (joint < 0) continue;
    int before = character.joints[size_t(joint)].parent;
    vec3 bone = next >= 0 ? at(next) - at(joint) : at(joint) - at(std::max(before, 0));
    vec3 axis = unit(cross(bone, goal - at(joint)), vec3(0));
    if (axis != vec3(0)) arm.fingers.push_back({joint, 0, k, 0, axis});
  }
  return arm;
}

LegRig make_leg(const Character& character, int side) {
  LegRig leg;
  std::string prefix = side == 0 ? "l_" : "r_";
  leg.hip = find_joint(character, prefix + "hip");
  leg.knee = find_joint(character, prefix + "knee");
  leg.ankle = find_joint(character, prefix + "talocrural");
  if (!leg.complete()) return leg;
  auto at = [&](int joint) { return character.joints[size_t(joint)].center; };
  bool chained = character.joints[size_t(leg.knee)].parent == leg.hip &&
                 character.joints[size_t(leg.ankle)].parent == leg.knee;
  vec3 line = at(leg.ankle) - at(leg.hip), thigh = at(leg.knee) - at(leg.hip);
  if (!chained || glm::length(thigh) < 0.02f || glm::length(at(leg.ankle) - at(leg.knee)) < 0.02f) {
    leg.hip = -1;
    return leg;
  }
  vec3 along = unit(line, down);
  vec3 off = thigh - along * dot(thigh, along);
  leg.pole = off.z > 0.004f ? unit(off, vec3(0, 0, 1))
                            : unit(vec3(0, 0, 1) - along * along.z, vec3(0, 0, 1));
  return leg;
}

}  // namespace

Rig make_rig(const Character& character) {
  Rig rig;
  rig.character = &character;
  rig.joints = character.joints.size();
  rig.displacers = character.displacers.size();
  auto joint = [&](const char* name) { return find_joint(character, name); };
  rig.root = std::max(joint("humanoid_root"), 0);
  rig.skull = joint("skullbase");
  rig.jaw = joint("temporomandibular");
  rig.eye = {joint("l_eyeball_joint"), joint("r_eyeball_joint")};
  rig.lid = {joint("l_eyelid_joint"), joint("r_eyelid_joint")};
  rig.jaw_moves = has_vertices(character, rig.jaw);
  rig.lids_move = has_vertices(character, rig.lid[0]) && has_vertices(character, rig.lid[1]);
  rig.eyes_move = has_vertices(character, rig.eye[0]) && has_vertices(character, rig.eye[1]);

  int top = rig.skull;
  for (const char* name : {"vc1", "vc2", "vc4", "vc7", "vt1", "vt6", "vt10", "vl1", "vl5"})
    if (top < 0) top = joint(name);
  for (int j = top; j >= 0; j = character.joints[size_t(j)].parent) {
    const std::string& name = character.joints[size_t(j)].name;
    if (name == "skullbase") rig.neck.push_back({j, 3});
    else if (name == "vc1" || name == "vc2") rig.neck.push_back({j, 2});
    else if (name.rfind("vc", 0) == 0) rig.neck.push_back({j, 1});
    else if (name.rfind("vt", 0) == 0 || name.rfind("vl", 0) == 0) rig.spine.push_back({j, 1});
  }
  for (auto* chain : {&rig.neck, &rig.spine}) {
    std::reverse(chain->begin(), chain->end());
    float sum = 0, ready = 0;
    for (const WeightedJoint& link : *chain)
      ready += link.share * readiness(character.joints[size_t(link.joint)]);
    for (WeightedJoint& link : *chain) {
      if (ready > 1e-3f) link.share *= readiness(character.joints[size_t(link.joint)]);
      sum += link.share;
    }
    for (WeightedJoint& link : *chain) link.share /= sum;
  }
  for (int side = 0; side < 2; side++) {
    rig.arm[size_t(side)] = make_arm(character, side);
    rig.leg[size_t(side)] = make_leg(character, side);
  }
  if (rig.eyes_move) {
    rig.eyes_center = 0.5f * (character.joints[size_t(rig.eye[0])].center +
                              character.joints[size_t(rig.eye[1])].center);
  } else if (rig.skull >= 0) {
    rig.eyes_center = character.joints[size_t(rig.skull)].center + vec3(0, 0.06f, 0.08f);
  } else {
    float high = 1.6f;
    for (vec3 p : character.positions) high = std::max(high, p.y);
    rig.eyes_center = {0, high - 0.1f, 0.08f};
  }

  auto displacer = [&](const std::string& name) { return find_displacer(character, name); };
  auto pair = [&](const std::string& name) {
    return std::array<int, 2>{displacer(name + "_l"), displacer(name + "_r")};
  };
  rig.blink = pair("blink");
  rig.smile = pair("smile");
  rig.brow_up = pair("brow_up");
  rig.squint = pair("squint");
  rig.lid_wide = pair("lid_wide");
  if (rig.squint[0] < 0) rig.squint[0] = displacer("squint");
  if (rig.lid_wide[0] < 0) rig.lid_wide[0] = displacer("lid_wide");
  rig.brow_inner_up = displacer("brow_inner_up");
  rig.mouth_open = displacer("mouth_open");
  rig.breathe = displacer("breathe");
  const char* visemes[15] = {"sil", "PP", "FF", "TH", "DD", "kk", "CH", "SS",
                             "nn",  "RR", "aa", "E",  "ih", "oh", "ou"};
  for (size_t i = 0; i < 15; i++) {
    std::string name = std::string("viseme_") + visemes[i], small = name;
    for (char& c : small) c = char(std::tolower(static_cast<unsigned char>(c)));
    rig.viseme[i] = displacer(name);
    if (rig.viseme[i] < 0) rig.viseme[i] = displacer(small);
  }
  const char* names[4] = {"lookUp", "lookDown", "lookLeft", "lookRight"};
  for (size_t i = 0; i < 4; i++) rig.look[i] = find_displacer(character, names[i]);
  return rig;
}

}  // namespace wellspring::avatar
