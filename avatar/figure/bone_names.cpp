// SPDX-License-Identifier: Apache-2.0
#include "avatar/figure/bone_names.h"

#include <algorithm>
#include <array>
#include <set>

#include "avatar/figure/hanim_names.h"

namespace wellspring::avatar {
namespace {

struct Namer {
  const std::vector<Bone>& bones;
  std::vector<BoneWord> words;
  std::vector<std::string> joints;
  std::set<std::string> used;

  explicit Namer(const std::vector<Bone>& from) : bones(from), joints(from.size()) {
    for (const Bone& bone : bones) words.push_back(read_bone_name(bone.name));
  }
  void give(int bone, const std::string& joint) {
    if (bone >= 0 && joints[size_t(bone)].empty() && used.insert(joint).second)
      joints[size_t(bone)] = joint;
  }
  // Finds the topmost bone of this part, below `above` (-1: anywhere).
  int find(BonePart part, int side, int above = -1) const {
    for (size_t i = 0; i < bones.size(); i++)
      if (words[i].part == part && words[i].side == side && (above < 0 || is_below(int(i), above)))
        return int(i);
    return -1;
  }
  bool is_below(int bone, int ancestor) const {
    for (; bone >= 0; bone = bones[size_t(bone)].parent)
      if (bone == ancestor) return true;
    return false;
  }
  int common_ancestor(int a, int b) const {
    while (a >= 0 && b >= 0 && a != b) (a > b ? a : b) = bones[size_t(std::max(a, b))].parent;
    return a == b ? a : -1;
  }

  struct Limb {
    int first = -1, second = -1, third = -1,
        fourth = -1;  // collar, shoulder, elbow, wrist; or hip ...
  };
  Limb name_arm(int side);
  Limb name_leg(int side);
  void name_hand(int side, int wrist);
  void name_trunk(const std::array<Limb, 2>& arms, const std::array<Limb, 2>& legs);
  void name_face();
};

std::string sided(int side, const char* joint) {
  std::string name = side == 0 ? "l_" : "r_";
  return name.append(joint);
}

// Names an arm. "Shoulder" is the collar bone if the arm has a bone of its own, "Arm" the forearm
// if another bone is the upper one.
Namer::Limb Namer::name_arm(int side) {
  int collar = find(BonePart::collar, side), shoulder = find(BonePart::shoulder, side);
  int upper = find(BonePart::upper_arm, side), arm = find(BonePart::arm, side);
  int fore = find(BonePart::forearm, side), wrist = find(BonePart::wrist, side);
  if (wrist < 0) wrist = find(BonePart::hand, side);
  if (upper < 0 && arm >= 0 && (fore >= 0 || shoulder < 0)) upper = arm;
  else if (upper >= 0 && fore < 0) fore = arm;
  if (upper >= 0 && collar < 0) collar = shoulder;
  if (upper < 0) {
    upper = shoulder;
    if (fore < 0) fore = arm;
  }
  if (fore >= 0 && upper >= 0 && !is_below(fore, upper)) fore = -1;
  if (wrist >= 0 && fore >= 0 && !is_below(wrist, fore)) wrist = -1;
  if (collar >= 0 && upper >= 0 && !is_below(upper, collar)) collar = -1;
  give(upper, sided(side, "shoulder"));
  give(collar, sided(side, "sternoclavicular"));
  give(fore, sided(side, "elbow"));
  give(wrist, sided(side, "radiocarpal"));
  return {collar, upper, fore, wrist};
}

Namer::Limb Namer::name_leg(int side) {
  int thigh = find(BonePart::thigh, side), hip = find(BonePart::hip, side);
  int leg = find(BonePart::leg, side), shin = find(BonePart::shin, side);
  int ankle = find(BonePart::ankle, side), foot = find(BonePart::foot, side);
  int toe = find(BonePart::toe, side);
  if (thigh < 0) thigh = hip;
  if (thigh < 0 && shin >= 0) thigh = leg;
  if (shin < 0 && leg != thigh) shin = leg;
  if (ankle < 0) ankle = foot;
  else if (toe < 0) toe = foot;
  if (shin >= 0 && thigh >= 0 && !is_below(shin, thigh)) shin = -1;
  if (ankle >= 0 && shin >= 0 && !is_below(ankle, shin)) ankle = -1;
  if (toe >= 0 && ankle >= 0 && !is_below(toe, ankle)) toe = -1;
  give(thigh, sided(side, "hip"));
  give(shin, sided(side, "knee"));
  give(ankle, sided(side, "talocrural"));
  give(toe, sided(side, "metatarsophalangeal_2"));
  return {thigh, shin, ankle, toe};
}

// Names a hand: three bones a finger from the palm; a fourth before them lies within it.
void Namer::name_hand(int side, int wrist) {
  constexpr const char* names[] = {"carpometacarpal_", "metacarpophalangeal_",
                                   "carpal_proximal_interphalangeal_",
                                   "carpal_distal_interphalangeal_"};
  for (int f = 0; f < 5; f++) {
    std::vector<std::pair<int, int>> chain;  // number, bone
    for (size_t i = 0; i < bones.size(); i++)
      if (words[i].part == BonePart(int(BonePart::thumb) + f) && words[i].side == side &&
          (wrist < 0 || is_below(int(i), wrist)))
        chain.push_back({words[i].number, int(i)});
    std::stable_sort(chain.begin(), chain.end(),
                     [](auto& a, auto& b) { return a.second < b.second; });  // from the palm
    bool inner = !chain.empty() && chain[0].first == 0 && chain.size() > 3;
    for (size_t k = 0; k < chain.size() && k < 4; k++) {
      size_t knuckle = f == 0 ? k : k + (inner ? 0 : 1);
      if (f == 0 && k < 3)
        give(chain[k].second, sided(side, k == 0   ? "carpometacarpal_1"
                                          : k == 1 ? "metacarpophalangeal_1"
                                                   : "carpal_interphalangeal_1"));
      else if (f > 0 && knuckle < 4)
        give(chain[k].second, sided(side, names[knuckle]) + std::to_string(f + 1));
    }
  }
}

// Names the way from the hips to the head: below the arms it is spine, above them neck.
void Namer::name_trunk(const std::array<Limb, 2>& arms, const std::array<Limb, 2>& legs) {
  int hips = find(BonePart::hips, -1);
  int legs_meet = common_ancestor(legs[0].first, legs[1].first);
  if (hips < 0) hips = legs_meet >= 0 ? legs_meet : find(BonePart::root, -1);
  auto top_of = [](const Limb& arm) { return arm.first >= 0 ? arm.first : arm.second; };
  int chest = common_ancestor(top_of(arms[0]), top_of(arms[1]));
  if (hips >= 0 && chest >= 0 && !is_below(chest, hips)) hips = common_ancestor(hips, chest);
  give(hips, "humanoid_root");
  if (legs_meet >= 0 && legs_meet != hips && is_below(legs_meet, hips) &&
      words[size_t(legs_meet)].part == BonePart::hips)
    give(legs_meet, "sacroiliac");
  int head = find(BonePart::head, -1), top = head;
  if (top < 0) {  // some rigs number the spine right up into the skull
    top = find(BonePart::neck, -1);
    for (size_t i = 0; i < bones.size(); i++)
      if ((words[i].part == BonePart::spine || words[i].part == BonePart::neck) && chest >= 0 &&
          int(i) != chest && is_below(int(i), chest))
        head = top = int(i);
  }
  if (top < 0) top = chest;
  std::vector<int> spine, neck;
  for (int i = head >= 0 ? bones[size_t(head)].parent : top; i >= 0 && i != hips;
       i = bones[size_t(i)].parent) {
    if (!joints[size_t(i)].empty()) continue;
    bool above_arms =
        chest >= 0 ? i != chest && is_below(i, chest) : words[size_t(i)].part == BonePart::neck;
    (above_arms ? neck : spine).push_back(i);
  }
  std::reverse(spine.begin(), spine.end());
  std::reverse(neck.begin(), neck.end());
  give(head, "skullbase");
  std::vector<std::string> names = spine_names(spine.size());
  for (size_t k = 0; k < names.size(); k++) give(spine[k], names[k]);
  names = neck_names(neck.size());
  for (size_t k = 0; k < names.size(); k++) give(neck[k], names[k]);
}

void Namer::name_face() {
  give(find(BonePart::jaw, -1), "temporomandibular");
  for (int side = 0; side < 2; side++) {
    give(find(BonePart::eye, side), sided(side, "eyeball_joint"));
    give(find(BonePart::lid, side), sided(side, "eyelid_joint"));
    give(find(BonePart::brow, side), sided(side, "eyebrow_joint"));
  }
}

}  // namespace

std::vector<std::string> spine_names(size_t count) {
  // These vertebrae are in the order in which more of them are worth having.
  constexpr const char* wanted[] = {"vl5",  "vt10", "vt6", "vl1", "vl3", "vt1",
                                    "vt12", "vt8",  "vt4", "vl4", "vl2", "vt11",
                                    "vt9",  "vt7",  "vt5", "vt3", "vt2"};
  constexpr const char* upwards[] = {"vl5",  "vl4",  "vl3", "vl2", "vl1", "vt12",
                                     "vt11", "vt10", "vt9", "vt8", "vt7", "vt6",
                                     "vt5",  "vt4",  "vt3", "vt2", "vt1"};
  std::set<std::string> chosen(std::begin(wanted),
                               std::begin(wanted) + std::min<size_t>(count, 17));
  std::vector<std::string> names;
  for (const char* name : upwards)
    if (chosen.count(name)) names.push_back(name);
  return names;
}

std::vector<std::string> neck_names(size_t count) {
  constexpr const char* wanted[] = {"vc4", "vc2", "vc7", "vc6", "vc5", "vc3", "vc1"};
  constexpr const char* upwards[] = {"vc7", "vc6", "vc5", "vc4", "vc3", "vc2", "vc1"};
  std::set<std::string> chosen(std::begin(wanted), std::begin(wanted) + std::min<size_t>(count, 7));
  std::vector<std::string> names;
  for (const char* name : upwards)
    if (chosen.count(name)) names.push_back(name);
  return names;
}

BoneNames name_bones(const std::vector<Bone>& bones) {
  Namer namer(bones);
  // H-Anim's own names come first.
  size_t own = 0;
  for (size_t i = 0; i < bones.size(); i++) {
    std::string joint = hanim_joint_name(bones[i].name);
    bool loose = joint.find('_') == std::string::npos && namer.words[i].part != BonePart::none;
    if (joint.empty() || loose || namer.words[i].part == BonePart::helper) continue;
    own += hanim_joint_level(bones[i].name) >= 0 || joint == "humanoid_root";
    namer.give(int(i), joint);
  }
  if (own < 6) {
    namer.joints.assign(bones.size(), "");
    namer.used.clear();
    std::array<Namer::Limb, 2> arms, legs;
    for (int side = 0; side < 2; side++) {
      arms[size_t(side)] = namer.name_arm(side);
      legs[size_t(side)] = namer.name_leg(side);
      namer.name_hand(side, arms[size_t(side)].fourth);
    }
    namer.name_trunk(arms, legs);
    namer.name_face();
  }
  BoneNames result{std::move(namer.joints), false};
  bool body = namer.used.count("l_shoulder") || namer.used.count("l_hip");
  if (body) return result;
  std::vector<std::string> shape = name_bones_by_shape(bones);
  if (std::find(shape.begin(), shape.end(), "l_hip") == shape.end()) return result;
  return {std::move(shape), true};
}

quat upright_turn(const std::vector<std::string>& joints, const std::vector<vec3>& places) {
  auto at = [&](const char* name) {
    size_t i = size_t(std::find(joints.begin(), joints.end(), name) - joints.begin());
    return i < joints.size() ? int(i) : -1;
  };
  vec3 left(0), up(0);
  for (const char* pair : {"shoulder", "hip", "elbow", "knee"}) {
    int l = at(("l_" + std::string(pair)).c_str()), r = at(("r_" + std::string(pair)).c_str());
    if (l >= 0 && r >= 0) left += places[size_t(l)] - places[size_t(r)];
  }
  int low = at("humanoid_root"), high = at("skullbase");
  if (high < 0) high = at("l_shoulder");
  if (low < 0) low = at("l_hip");
  if (low >= 0 && high >= 0) up = places[size_t(high)] - places[size_t(low)];
  if (!(glm::length(left) > 1e-6f) || !(glm::length(up) > 1e-6f)) return quat(1, 0, 0, 0);
  left = glm::normalize(left);
  up = glm::normalize(up);
  quat best(1, 0, 0, 0);
  float most = -1e9f;
  for (int i = 0; i < 24; i++) {  // the 24 turns of a cube
    constexpr float right_angle = pi / 2;
    quat spin = glm::angleAxis(right_angle * float(i % 4), vec3(0, 1, 0));
    int face = i / 4;
    quat tip = face < 4 ? glm::angleAxis(right_angle * float(face), vec3(1, 0, 0))
                        : glm::angleAxis(face == 4 ? right_angle : -right_angle, vec3(0, 0, 1));
    quat turn = spin * tip;
    float fits = dot(turn * left, vec3(1, 0, 0)) + dot(turn * up, vec3(0, 1, 0));
    if (fits > most + 1e-4f) most = fits, best = turn;
  }
  return best;
}

}  // namespace wellspring::avatar
