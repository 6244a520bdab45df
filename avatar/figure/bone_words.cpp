// SPDX-License-Identifier: Apache-2.0
// Reads what one bone's name says: "mixamorig:LeftForeArm", "upperarm_l", "Bip01 R Finger11",
// "f_index.02.L".
#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <unordered_map>
#include <unordered_set>

#include "avatar/figure/bone_names.h"
#include "base/load_error.h"

namespace wellspring::avatar {
namespace {

// Splits a name into words: at punctuation, at small-to-capital and letter-to-digit borders.
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

// The parts' names in avatar/library/bone_words.json, in the order of BonePart.
constexpr std::string_view part_names[] = {
    "none",  "root",  "hips",   "spine",    "neck",      "head",   "eye",     "jaw",
    "lid",   "brow",  "collar", "shoulder", "upper_arm", "arm",    "forearm", "wrist",
    "hand",  "hip",   "thigh",  "leg",      "shin",      "ankle",  "foot",    "toe",
    "thumb", "index", "middle", "ring",     "little",    "finger", "helper"};
static_assert(std::size(part_names) == size_t(BonePart::helper) + 1);

// The words of avatar/library/bone_words.json.
struct Vocabulary {
  std::unordered_set<std::string> left, right, noise, helpers;
  std::unordered_map<std::string, BonePart> parts;

  Vocabulary() {
    const auto words = nlohmann::json::parse(bone_words_json());
    words.at("left").get_to(left), words.at("right").get_to(right);
    words.at("noise").get_to(noise), words.at("helpers").get_to(helpers);
    for (const auto& [name, known] : words.at("parts").items()) {
      const auto found = std::find(std::begin(part_names), std::end(part_names), name);
      if (found == std::end(part_names)) throw LoadError("bone_words.json", "/parts", name);
      for (const std::string word : known) parts[word] = BonePart(found - std::begin(part_names));
    }
  }
};

const Vocabulary& vocabulary() {
  static const Vocabulary words;
  return words;
}

int side_of(const std::string& word) {
  return vocabulary().left.contains(word) ? 0 : vocabulary().right.contains(word) ? 1 : -1;
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
  const Vocabulary& known = vocabulary();
  BoneWord result;
  std::vector<std::string> words = words_of(name), rest;
  std::string digits;
  int segment = -1;
  for (std::string& word : words) {
    if (known.helpers.contains(word)) return {BonePart::helper, result.side, -1};
    // Words like "leftupperarm" or "rthigh" are in no table, so the side is cut off.
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
    else if (!known.noise.contains(word)) rest.push_back(word);
  }
  // A figure's own name may stand before the part, and nothing but numbers behind it.
  for (size_t skip = 0; skip < rest.size() && result.part == BonePart::none; skip++) {
    std::string key;
    for (size_t i = skip; i < rest.size(); i++) key += rest[i];
    auto found = known.parts.find(key);
    if (found != known.parts.end()) result.part = found->second;
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
