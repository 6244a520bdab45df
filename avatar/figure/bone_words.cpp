// SPDX-License-Identifier: Apache-2.0
// What one bone's name says: "mixamorig:LeftForeArm", "upperarm_l", "Bip01 R Finger11",
// "f_index.02.L".
#include <algorithm>
#include <cctype>
#include <unordered_map>

#include "avatar/figure/bone_names.h"

namespace wellspring::avatar {
namespace {

// Words of a name: cut at punctuation, at small-to-capital and letter-to-digit borders.
std::vector<std::string> words_of(std::string_view name) {
  for (char cut : {':', '|'}) {
    size_t at = name.rfind(cut);
    if (at != std::string_view::npos && at + 1 < name.size()) name.remove_prefix(at + 1);
  }
  auto kind = [](char c) {
    unsigned char u = static_cast<unsigned char>(c);
    return std::isdigit(u) ? 'd' : std::isupper(u) ? 'U' : std::isalpha(u) ? 'l' : ' ';
  };
  std::vector<std::string> words;
  bool open = false;
  for (size_t i = 0; i < name.size() && i < 200; i++) {
    char k = kind(name[i]), before = i ? kind(name[i - 1]) : ' ';
    if (k == ' ') {
      open = false;
      continue;
    }
    bool digits = (k == 'd') != (before == 'd');
    bool capital = k == 'U' && (before == 'l' || (i + 1 < name.size() && kind(name[i + 1]) == 'l'));
    if (!open || digits || capital) words.emplace_back();
    words.back() += char(std::tolower(static_cast<unsigned char>(name[i])));
    open = true;
  }
  return words;
}

int side_of(const std::string& word) {
  if (word == "l" || word == "left" || word == "lf" || word == "lft") return 0;
  if (word == "r" || word == "right" || word == "rt" || word == "rgt") return 1;
  return -1;
}

bool is_noise(const std::string& word) {
  for (const char* noise :
       {"mixamorig", "bip",      "biped",    "valve",     "valvebiped", "def", "j",
        "jnt",       "jt",       "joint",    "bone",      "bones",      "c",   "cc",
        "base",      "armature", "skeleton", "sk",        "b",          "rig", "bend",
        "f",         "bind",     "char",     "character", "human",      "main"})
    if (word == noise) return true;
  return false;
}

bool is_helper(const std::string& word) {
  for (const char* helper :
       {"twist",    "roll",   "ik",     "fk",         "pole",    "target",   "end",
        "tip",      "nub",    "ctrl",   "control",    "mch",     "prop",     "weapon",
        "attach",   "socket", "hair",   "skirt",      "bust",    "breast",   "sec",
        "cloth",    "tail",   "wing",   "corrective", "helper",  "share",    "dummy",
        "effector", "goal",   "camera", "mesh",       "sleeve",  "coat",     "ear",
        "tongue",   "teeth",  "volume", "muscle",     "org",     "ribbon",   "hood",
        "hat",      "tie",    "site",   "phys",       "physics", "collider", "accessory"})
    if (word == helper) return true;
  return false;
}

const std::unordered_map<std::string, BonePart>& parts() {
  using P = BonePart;
  static const std::unordered_map<std::string, BonePart> table = {{"root", P::root},
                                                                  {"hips", P::hips},
                                                                  {"pelvis", P::hips},
                                                                  {"humanoidroot", P::hips},
                                                                  {"cog", P::hips},
                                                                  {"spine", P::spine},
                                                                  {"torso", P::spine},
                                                                  {"abdomen", P::spine},
                                                                  {"abdomenlower", P::spine},
                                                                  {"abdomenupper", P::spine},
                                                                  {"lowerback", P::spine},
                                                                  {"upperback", P::spine},
                                                                  {"back", P::spine},
                                                                  {"waist", P::spine},
                                                                  {"belly", P::spine},
                                                                  {"stomach", P::spine},
                                                                  {"trunk", P::spine},
                                                                  {"spinelower", P::spine},
                                                                  {"spinemid", P::spine},
                                                                  {"spineupper", P::spine},
                                                                  {"chest", P::spine},
                                                                  {"upperchest", P::spine},
                                                                  {"chestupper", P::spine},
                                                                  {"chestlower", P::spine},
                                                                  {"lowerchest", P::spine},
                                                                  {"thorax", P::spine},
                                                                  {"ribcage", P::spine},
                                                                  {"lumbar", P::spine},
                                                                  {"neck", P::neck},
                                                                  {"necklower", P::neck},
                                                                  {"neckupper", P::neck},
                                                                  {"lowerneck", P::neck},
                                                                  {"upperneck", P::neck},
                                                                  {"head", P::head},
                                                                  {"skull", P::head},
                                                                  {"jaw", P::jaw},
                                                                  {"lowerjaw", P::jaw},
                                                                  {"mandible", P::jaw},
                                                                  {"eye", P::eye},
                                                                  {"eyeball", P::eye},
                                                                  {"faceeye", P::eye},
                                                                  {"eyelid", P::lid},
                                                                  {"eyelidupper", P::lid},
                                                                  {"upperlid", P::lid},
                                                                  {"uppereyelid", P::lid},
                                                                  {"eyebrow", P::brow},
                                                                  {"brow", P::brow},
                                                                  {"clavicle", P::collar},
                                                                  {"collar", P::collar},
                                                                  {"collarbone", P::collar},
                                                                  {"clavicula", P::collar},
                                                                  {"shoulder", P::shoulder},
                                                                  {"shldr", P::shoulder},
                                                                  {"upperarm", P::upper_arm},
                                                                  {"uparm", P::upper_arm},
                                                                  {"armupper", P::upper_arm},
                                                                  {"bicep", P::upper_arm},
                                                                  {"humerus", P::upper_arm},
                                                                  {"arm", P::arm},
                                                                  {"elbow", P::forearm},
                                                                  {"forearm", P::forearm},
                                                                  {"lowerarm", P::forearm},
                                                                  {"lowarm", P::forearm},
                                                                  {"armlower", P::forearm},
                                                                  {"ulna", P::forearm},
                                                                  {"wrist", P::wrist},
                                                                  {"hand", P::hand},
                                                                  {"hip", P::hip},
                                                                  {"thigh", P::thigh},
                                                                  {"upperleg", P::thigh},
                                                                  {"upleg", P::thigh},
                                                                  {"legupper", P::thigh},
                                                                  {"femur", P::thigh},
                                                                  {"leg", P::leg},
                                                                  {"shin", P::shin},
                                                                  {"calf", P::shin},
                                                                  {"lowerleg", P::shin},
                                                                  {"lowleg", P::shin},
                                                                  {"leglower", P::shin},
                                                                  {"tibia", P::shin},
                                                                  {"knee", P::shin},
                                                                  {"ankle", P::ankle},
                                                                  {"foot", P::foot},
                                                                  {"feet", P::foot},
                                                                  {"toe", P::toe},
                                                                  {"toes", P::toe},
                                                                  {"toebase", P::toe},
                                                                  {"ball", P::toe},
                                                                  {"thumb", P::thumb},
                                                                  {"handthumb", P::thumb},
                                                                  {"thumbfinger", P::thumb},
                                                                  {"index", P::index},
                                                                  {"handindex", P::index},
                                                                  {"indexfinger", P::index},
                                                                  {"fingerindex", P::index},
                                                                  {"middle", P::middle},
                                                                  {"handmiddle", P::middle},
                                                                  {"mid", P::middle},
                                                                  {"middlefinger", P::middle},
                                                                  {"fingermiddle", P::middle},
                                                                  {"ring", P::ring},
                                                                  {"handring", P::ring},
                                                                  {"ringfinger", P::ring},
                                                                  {"fingerring", P::ring},
                                                                  {"little", P::little},
                                                                  {"pinky", P::little},
                                                                  {"pinkie", P::little},
                                                                  {"handpinky", P::little},
                                                                  {"littlefinger", P::little},
                                                                  {"pinkyfinger", P::little},
                                                                  {"fingerpinky", P::little},
                                                                  {"handlittle", P::little},
                                                                  {"finger", P::finger}};
  return table;
}

bool is_finger(BonePart part) { return part >= BonePart::thumb && part <= BonePart::finger; }

// 3ds Max counts fingers from the thumb, then their bones: "Finger2", "Finger21", "Finger22".
void read_biped_finger(const std::string& digits, BoneWord& word) {
  if (digits.empty() || digits[0] > '4') return;
  word.part = BonePart(int(BonePart::thumb) + (digits[0] - '0'));
  word.number = digits.size() > 1 ? digits[1] - '0' + 1 : 1;
}

}  // namespace

BoneWord read_bone_name(std::string_view name) {
  BoneWord result;
  std::vector<std::string> words = words_of(name), rest;
  std::string digits;
  int segment = -1;
  for (std::string& word : words) {
    if (is_helper(word)) return {BonePart::helper, result.side, -1};
    // "leftupperarm", "rthigh" are left to the table, which knows no such word: cut the side off.
    for (const char* prefix : {"left", "right"}) {
      size_t length = std::char_traits<char>::length(prefix);
      if (word.size() > length && word.compare(0, length, prefix) == 0) {
        result.side = prefix[0] == 'l' ? 0 : 1;
        word.erase(0, length);
      }
    }
    int side = side_of(word);
    if (side >= 0) result.side = side;
    else if (std::isdigit(static_cast<unsigned char>(word[0]))) {
      if (!rest.empty()) digits = word;  // digits before any part belong to a prefix ("Bip01")
    } else if (word == "proximal") segment = 1;
    else if (word == "intermediate" || word == "medial") segment = 2;
    else if (word == "distal") segment = 3;
    else if (word == "metacarpal" || word == "carpal") segment = 0;
    else if (!is_noise(word)) rest.push_back(word);
  }
  // A figure's own name may stand before the part, nothing but numbers behind it.
  for (size_t skip = 0; skip < rest.size() && result.part == BonePart::none; skip++) {
    std::string key;
    for (size_t i = skip; i < rest.size(); i++) key += rest[i];
    auto found = parts().find(key);
    if (found != parts().end()) result.part = found->second;
  }
  if (result.part == BonePart::none) return {};
  if (result.part == BonePart::finger) {
    read_biped_finger(digits, result);
    return result.part == BonePart::finger ? BoneWord{} : result;
  }
  if (segment >= 0) result.number = segment;
  else if (!digits.empty()) result.number = std::atoi(digits.substr(0, 6).c_str());
  if (result.part == BonePart::hip && result.side < 0) result.part = BonePart::hips;
  bool sided =
      (result.part >= BonePart::eye && result.part != BonePart::jaw) || is_finger(result.part);
  if (sided && result.side < 0) return {};
  return result;
}

std::string vrm_bone_joint(std::string_view bone, int version) {
  struct Row {
    const char *bone, *joint;
  };
  static constexpr Row centre[] = {
      {"hips", "humanoid_root"},   {"spine", "vl5"}, {"chest", "vt10"},
      {"upperChest", "vt6"},       {"neck", "vc4"},  {"head", "skullbase"},
      {"jaw", "temporomandibular"}};
  static constexpr Row sided[] = {{"Eye", "eyeball_joint"},
                                  {"UpperLeg", "hip"},
                                  {"LowerLeg", "knee"},
                                  {"Foot", "talocrural"},
                                  {"Toes", "metatarsophalangeal_2"},
                                  {"Shoulder", "sternoclavicular"},
                                  {"UpperArm", "shoulder"},
                                  {"LowerArm", "elbow"},
                                  {"Hand", "radiocarpal"},
                                  {"ThumbMetacarpal", "carpometacarpal_1"},
                                  {"ThumbDistal", "carpal_interphalangeal_1"}};
  for (const Row& row : centre)
    if (bone == row.bone) return row.joint;
  std::string side;
  if (bone.rfind("left", 0) == 0) side = "l_", bone.remove_prefix(4);
  else if (bone.rfind("right", 0) == 0) side = "r_", bone.remove_prefix(5);
  else return "";
  for (const Row& row : sided)
    if (bone == row.bone) return side + row.joint;
  // VRM 0 names the thumb's three bones proximal, intermediate, distal.
  if (bone == "ThumbProximal")
    return side + (version == 0 ? "carpometacarpal_1" : "metacarpophalangeal_1");
  if (bone == "ThumbIntermediate") return side + "metacarpophalangeal_1";
  constexpr const char* fingers[] = {"Index", "Middle", "Ring", "Little"};
  for (int f = 0; f < 4; f++) {
    std::string finger = fingers[f], digit = std::to_string(f + 2);
    if (bone == finger + "Proximal") return side + "metacarpophalangeal_" + digit;
    if (bone == finger + "Intermediate") return side + "carpal_proximal_interphalangeal_" + digit;
    if (bone == finger + "Distal") return side + "carpal_distal_interphalangeal_" + digit;
  }
  return "";
}

}  // namespace wellspring::avatar
