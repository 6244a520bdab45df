// SPDX-License-Identifier: Apache-2.0
#include "avatar/figure/retarget.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace wellspring::avatar {
namespace {

using Index = std::unordered_map<std::string, int>;

int find(const Index& index, const std::string& name) {
  auto found = index.find(name);
  return found == index.end() ? -1 : found->second;
}

// Returns the joint a limb's bone leads to; empty if rest poses are alike anyway (feet stand flat,
// spines are upright).
std::string next_in_limb(const std::string& joint) {
  if (joint.size() < 3 || joint[1] != '_') return "";
  std::string side = joint.substr(0, 2), part = joint.substr(2);
  if (part == "shoulder") return side + "elbow";
  if (part == "elbow") return side + "radiocarpal";
  if (part == "radiocarpal") return side + "metacarpophalangeal_3";
  if (part == "hip") return side + "knee";
  if (part == "knee") return side + "talocrural";
  for (const char* digit : {"2", "3", "4", "5"}) {
    std::string d = digit;
    if (part == "metacarpophalangeal_" + d) return side + "carpal_proximal_interphalangeal_" + d;
    if (part == "carpal_proximal_interphalangeal_" + d)
      return side + "carpal_distal_interphalangeal_" + d;
  }
  if (part == "carpometacarpal_1") return side + "metacarpophalangeal_1";
  if (part == "metacarpophalangeal_1") return side + "carpal_interphalangeal_1";
  return "";
}

bool is_foot(const std::string& joint) {
  return joint.find("talocrural") != std::string::npos || joint.find("tarsal") != std::string::npos;
}

quat turn_between(vec3 from, vec3 to) {
  float a = glm::length(from), b = glm::length(to);
  if (!(a > 1e-5f) || !(b > 1e-5f)) return quat(1, 0, 0, 0);
  from /= a, to /= b;
  float c = dot(from, to);
  if (c < -0.9999f) return glm::angleAxis(pi, vec3(0, 0, 1));
  return glm::normalize(quat(1 + c, cross(from, to)));
}

enum class Trunk { none, spine, neck };
Trunk trunk_of(const std::string& joint) {
  if (joint.size() < 3 || joint[0] != 'v') return Trunk::none;
  bool digits = joint[2] >= '0' && joint[2] <= '9';
  if (!digits) return Trunk::none;
  return joint[1] == 'l' || joint[1] == 't' ? Trunk::spine
         : joint[1] == 'c'                  ? Trunk::neck
                                            : Trunk::none;
}

// Returns the vertebrae of one kind from below, with what carries them in front; the neck ends in
// the skull.
template <class Joints>
std::vector<int> trunk_chain(const Joints& joints, Trunk kind) {
  std::vector<int> chain;
  for (size_t j = 0; j < joints.size(); j++)
    if (trunk_of(joints[j].name) == kind) chain.push_back(int(j));
  if (chain.empty()) return chain;
  std::vector<int> path;  // only vertebrae above one another
  for (int j = chain.back(); j >= 0; j = joints[size_t(j)].parent)
    if (trunk_of(joints[size_t(j)].name) == kind) path.push_back(j);
  std::reverse(path.begin(), path.end());
  path.insert(path.begin(), joints[size_t(path[0])].parent);
  for (size_t j = 0; kind == Trunk::neck && j < joints.size(); j++)
    if (joints[j].name == "skullbase") path.push_back(int(j));
  return path;
}

// Makes each vertebra of the figure turn as the motion's trunk does at the same height.
void link_trunk(const Motion& motion, const Character& character, Trunk kind, Retarget& retarget) {
  std::vector<int> ours = trunk_chain(character.joints, kind),
                   theirs = trunk_chain(motion.joints, kind);
  if (ours.size() < 2 || theirs.size() < 2) return;
  size_t last = ours.size() - 1;
  for (size_t k = 1; k <= last; k++) {
    if (trunk_of(character.joints[size_t(ours[k])].name) == Trunk::none)
      continue;  // leaves the skull itself out
    float place = float(k) / float(last) * float(theirs.size() - 1);
    size_t below = std::min(size_t(place), theirs.size() - 2);
    Retarget::Link& link = retarget.links[size_t(ours[k])];
    link.from = theirs[below];
    link.to = theirs[below + 1];
    link.share = place - float(below);
    link.moves = true;
  }
}

float floor_of(const std::vector<MotionJoint>& joints) {
  float low = INFINITY;
  for (const MotionJoint& joint : joints) low = std::min(low, joint.center.y);
  return std::isfinite(low) ? low : 0;
}

quat blend(quat from, quat to, float weight) {
  if (weight >= 1) return to;
  return glm::slerp(from, to, weight);  // takes the shorter way
}

}  // namespace

Retarget make_retarget(const Motion& motion, const Character& character) {
  Retarget retarget;
  retarget.links.resize(character.joints.size());
  Index theirs, ours;
  for (size_t j = 0; j < motion.joints.size(); j++) theirs.emplace(motion.joints[j].name, int(j));
  for (size_t j = 0; j < character.joints.size(); j++)
    ours.emplace(character.joints[j].name, int(j));
  retarget.root = find(ours, "humanoid_root");
  retarget.motion_root = find(theirs, "humanoid_root");
  std::vector<char> tracked(motion.joints.size(), 0);
  for (const MotionTrack& track : motion.tracks)
    if (track.kind != TrackKind::displacer) tracked[size_t(track.target)] = 1;

  retarget.same = motion.joints.size() == character.joints.size();
  for (size_t j = 0; retarget.same && j < motion.joints.size(); j++) {
    const MotionJoint& a = motion.joints[j];
    const Joint& b = character.joints[j];
    retarget.same =
        a.name == b.name && a.parent == b.parent && glm::length(a.center - b.center) < 1e-4f;
  }
  for (size_t j = 0; j < character.joints.size(); j++) {
    Retarget::Link& link = retarget.links[j];
    int other = retarget.same ? int(j) : find(theirs, character.joints[j].name);
    link.from = link.to = other;
    link.moves = other >= 0 && tracked[size_t(other)];
  }
  if (!retarget.same) {
    // A trunk moves as a whole or not at all.
    for (Trunk kind : {Trunk::spine, Trunk::neck}) {
      bool moves = false;
      for (size_t j = 0; j < motion.joints.size(); j++)
        moves = moves || (tracked[j] && trunk_of(motion.joints[j].name) == kind);
      if (moves) link_trunk(motion, character, kind, retarget);
    }
    for (size_t j = 0; j < character.joints.size(); j++) {
      const Joint& joint = character.joints[j];
      Retarget::Link& link = retarget.links[j];
      std::string next = next_in_limb(joint.name);
      quat above = joint.parent < 0 || trunk_of(joint.name) != Trunk::none
                       ? quat(1, 0, 0, 0)
                       : retarget.links[size_t(joint.parent)].align;
      link.align = is_foot(joint.name) ? quat(1, 0, 0, 0) : above;
      int our_next = find(ours, next), their_next = find(theirs, next);
      if (next.empty() || link.from < 0 || our_next < 0 || their_next < 0) continue;
      vec3 bone = character.joints[size_t(our_next)].center - joint.center;
      vec3 other =
          motion.joints[size_t(their_next)].center - motion.joints[size_t(link.from)].center;
      link.align = turn_between(above * bone, other) * above;
    }
  }
  if (retarget.root >= 0 && retarget.motion_root >= 0 && !retarget.same) {
    float here = character.joints[size_t(retarget.root)].center.y;
    float there = motion.joints[size_t(retarget.motion_root)].center.y - floor_of(motion.joints);
    float low = INFINITY;
    for (const Joint& joint : character.joints) low = std::min(low, joint.center.y);
    here -= low;
    if (there > 1e-3f && here > 1e-3f) retarget.scale = std::clamp(here / there, 1e-3f, 1e3f);
  }
  for (const std::string& name : motion.displacers) {
    int displacer = find_displacer(character, name);
    retarget.displacers.push_back(displacer);
    retarget.fits = retarget.fits || displacer >= 0;
  }
  for (const Retarget::Link& link : retarget.links) retarget.fits = retarget.fits || link.moves;
  return retarget;
}

void apply_motion(const Motion& motion, const Retarget& retarget, const Character& character,
                  double time, bool loop, float weight, Pose& pose) {
  if (!(weight > 0) || retarget.links.size() != character.joints.size()) return;
  weight = std::min(weight, 1.0f);
  MotionPose now;
  eval_motion(motion, time, loop, now);
  for (size_t d = 0; d < now.displacers.size(); d++) {
    int ours = retarget.displacers[d];
    if (ours >= 0)
      pose.displacers[size_t(ours)] =
          glm::mix(pose.displacers[size_t(ours)], now.displacers[d], weight);
  }
  size_t count = character.joints.size();
  if (retarget.same) {
    bool ways = false;
    for (vec3 way : now.translations) ways = ways || way != vec3(0);
    if (ways && pose.translations.empty()) pose.translations.assign(count, vec3(0));
    if (!now.stretches.empty() && pose.stretches.empty()) pose.stretches.assign(count, mat3(1));
    for (size_t j = 0; j < count; j++) {
      if (!retarget.links[j].moves) continue;
      pose.rotations[j] = blend(pose.rotations[j], now.rotations[j], weight);
      if (!pose.translations.empty())
        pose.translations[j] = glm::mix(pose.translations[j], now.translations[j], weight);
      if (!now.stretches.empty())
        pose.stretches[j] += (now.stretches[j] - pose.stretches[j]) * weight;
    }
    return;
  }
  // `turned` says how far each joint of the motion has turned from its rest, in humanoid space.
  std::vector<quat> turned(motion.joints.size());
  for (size_t j = 0; j < motion.joints.size(); j++) {
    int parent = motion.joints[j].parent;
    turned[j] = parent < 0 ? now.rotations[j] : turned[size_t(parent)] * now.rotations[j];
  }
  std::vector<quat> wanted(count);
  for (size_t j = 0; j < count; j++) {
    const Retarget::Link& link = retarget.links[j];
    int parent = character.joints[j].parent;
    quat above = parent < 0 ? quat(1, 0, 0, 0) : wanted[size_t(parent)];
    if (link.to < 0) {
      wanted[j] = above;
      continue;
    }
    quat from = link.from < 0 ? quat(1, 0, 0, 0) : turned[size_t(link.from)];
    quat turn = link.from == link.to ? from : glm::slerp(from, turned[size_t(link.to)], link.share);
    wanted[j] = turn * link.align;
    if (link.moves)
      pose.rotations[j] =
          blend(pose.rotations[j], glm::normalize(glm::conjugate(above) * wanted[j]), weight);
  }
  if (retarget.root < 0 || retarget.motion_root < 0) return;
  // The hips go where the motion's hips go, scaled to the figure's height.
  vec3 place(0);
  for (int j = retarget.motion_root; j >= 0; j = motion.joints[size_t(j)].parent) {
    const MotionJoint& joint = motion.joints[size_t(j)];
    vec3 from = j == retarget.motion_root ? joint.center : place;
    place = joint.center + now.translations[size_t(j)] +
            now.rotations[size_t(j)] * (from - joint.center);
  }
  vec3 way = (place - motion.joints[size_t(retarget.motion_root)].center) * retarget.scale;
  Pose still = pose;
  still.translation = vec3(0);
  vec3 rest = character.joints[size_t(retarget.root)].center;
  vec3 without = eval_joint_frame(character, still, retarget.root).center;
  if (is_finite(way)) pose.translation = glm::mix(pose.translation, rest + way - without, weight);
}

}  // namespace wellspring::avatar
