// SPDX-License-Identifier: Apache-2.0
#include "avatar/figure/hanim_names.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <unordered_map>
#include <unordered_set>

namespace wellspring::avatar {
namespace {

struct Row {
  const char* name;  // a left joint stands for its right twin too
  int level;
  const char* aliases;  // blank-separated, without the l_ of a left joint
};

constexpr Row rows[] = {
    {"humanoid_root", 0, "HumanoidRoot"},
    {"sacroiliac", 1, "SIJ"},
    {"l_hip", 1, ""},
    {"l_knee", 1, ""},
    {"l_talocrural", 1, "ankle"},
    {"l_talocalcaneonavicular", 4, "talocalcaneal"},
    {"l_cuneonavicular_1", 4, ""},
    {"l_tarsometatarsal_1", 4, ""},
    {"l_metatarsophalangeal_1", 4, ""},
    {"l_tarsal_interphalangeal_1", 4, ""},
    {"l_cuneonavicular_2", 4, "cuneonavicular"},
    {"l_tarsometatarsal_2", 2, "subtalar tarsometatarsal"},
    {"l_metatarsophalangeal_2", 1, "midtarsal metatarsophalangeal"},
    {"l_tarsal_proximal_interphalangeal_2", 4, "tarsal_proximal_interphalangeal"},
    {"l_tarsal_distal_interphalangeal_2", 2, "tarsal_distal_interphalangeal metatarsal"},
    {"l_cuneonavicular_3", 4, ""},
    {"l_tarsometatarsal_3", 4, ""},
    {"l_metatarsophalangeal_3", 4, ""},
    {"l_tarsal_proximal_interphalangeal_3", 4, ""},
    {"l_tarsal_distal_interphalangeal_3", 4, ""},
    {"l_calcaneocuboid", 4, "calcaneuscuboid"},
    {"l_transversetarsal", 4, ""},
    {"l_tarsometatarsal_4", 4, ""},
    {"l_metatarsophalangeal_4", 4, ""},
    {"l_tarsal_proximal_interphalangeal_4", 4, ""},
    {"l_tarsal_distal_interphalangeal_4", 4, ""},
    {"l_tarsometatarsal_5", 4, ""},
    {"l_metatarsophalangeal_5", 4, ""},
    {"l_tarsal_proximal_interphalangeal_5", 4, ""},
    {"l_tarsal_distal_interphalangeal_5", 4, ""},
    {"vl5", 1, ""},
    {"vl4", 3, ""},
    {"vl3", 2, ""},
    {"vl2", 3, ""},
    {"vl1", 2, ""},
    {"vt12", 3, ""},
    {"vt11", 3, ""},
    {"vt10", 2, ""},
    {"vt9", 3, ""},
    {"vt8", 3, ""},
    {"vt7", 3, ""},
    {"vt6", 2, ""},
    {"vt5", 3, ""},
    {"vt4", 3, ""},
    {"vt3", 3, ""},
    {"vt2", 3, ""},
    {"vt1", 2, ""},
    {"vc7", 3, ""},
    {"vc6", 3, ""},
    {"vc5", 3, ""},
    {"vc4", 2, ""},
    {"vc3", 3, ""},
    {"vc2", 2, ""},
    {"vc1", 3, ""},
    {"skullbase", 1, ""},
    {"l_eyelid_joint", 3, ""},
    {"l_eyeball_joint", 3, ""},
    {"l_eyebrow_joint", 3, ""},
    {"temporomandibular", 3, ""},
    {"l_sternoclavicular", 2, ""},
    {"l_acromioclavicular", 2, ""},
    {"l_shoulder", 1, ""},
    {"l_elbow", 1, ""},
    {"l_radiocarpal", 1, "wrist"},
    {"l_midcarpal_1", 4, ""},
    {"l_carpometacarpal_1", 2, "thumb1"},
    {"l_metacarpophalangeal_1", 2, "thumb2"},
    {"l_carpal_interphalangeal_1", 2, "thumb3"},
    {"l_midcarpal_2", 4, ""},
    {"l_carpometacarpal_2", 2, "index0 carpometacarpal"},
    {"l_metacarpophalangeal_2", 2, "index1 metacarpophalangeal"},
    {"l_carpal_proximal_interphalangeal_2", 2, "index2 carpal_proximal_interphalangeal"},
    {"l_carpal_distal_interphalangeal_2", 2, "index3 carpal_distal_interphalangeal"},
    {"l_midcarpal_3", 4, ""},
    {"l_carpometacarpal_3", 2, "middle0"},
    {"l_metacarpophalangeal_3", 2, "middle1"},
    {"l_carpal_proximal_interphalangeal_3", 2, "middle2"},
    {"l_carpal_distal_interphalangeal_3", 2, "middle3"},
    {"l_midcarpal_4_5", 4, ""},
    {"l_carpometacarpal_4", 2, "ring0"},
    {"l_metacarpophalangeal_4", 2, "ring1"},
    {"l_carpal_proximal_interphalangeal_4", 2, "ring2"},
    {"l_carpal_distal_interphalangeal_4", 2, "ring3"},
    {"l_carpometacarpal_5", 2, "pinky0"},
    {"l_metacarpophalangeal_5", 2, "pinky1"},
    {"l_carpal_proximal_interphalangeal_5", 2, "pinky2"},
    {"l_carpal_distal_interphalangeal_5", 2, "pinky3"},
};

struct Known {
  std::string name;
  int level;
};

// Every name and alias to its joint.
const std::unordered_map<std::string, Known>& known_joints() {
  static const auto table = [] {
    std::unordered_map<std::string, Known> made;
    for (const Row& row : rows) {
      std::string name = row.name;
      bool sided = name.rfind("l_", 0) == 0;
      for (const char* side : {"l_", "r_"}) {
        std::string full = sided ? std::string(side).append(name, 2) : name;
        made.emplace(full, Known{full, row.level});
        std::string aliases = row.aliases;
        for (size_t start = 0; start < aliases.size();) {
          size_t stop = std::min(aliases.find(' ', start), aliases.size());
          std::string alias = aliases.substr(start, stop - start);
          made.emplace(sided ? side + alias : alias, Known{full, row.level});
          start = stop + 1;
        }
        if (!sided) break;
      }
    }
    return made;
  }();
  return table;
}

}  // namespace

std::string hanim_joint_name(std::string_view text) {
  auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  const auto& table = known_joints();
  // The whole name first, then what follows each underscore: the longest known remainder wins.
  for (size_t start = 0; start < text.size();) {
    auto found = table.find(std::string(text.substr(start)));
    if (found != table.end()) return found->second.name;
    size_t underscore = text.find('_', start);
    if (underscore == std::string_view::npos) break;
    start = underscore + 1;
  }
  return "";
}

int hanim_joint_level(std::string_view joint) {
  auto found = known_joints().find(std::string(joint));
  return found == known_joints().end() || found->second.name != joint ? -1 : found->second.level;
}

int level_of_articulation(const std::vector<std::string_view>& joints) {
  int found[5] = {};
  std::vector<std::string_view> unique = joints;
  std::sort(unique.begin(), unique.end());
  unique.erase(std::unique(unique.begin(), unique.end()), unique.end());
  for (std::string_view joint : unique) {
    int level = hanim_joint_level(joint);
    for (int l = std::max(level, 0); level >= 0 && l < 5; l++) found[l]++;
  }
  int level = -1;
  while (level < 4 && found[level + 1] == hanim_joint_count(level + 1)) level++;
  return level;
}

int hanim_joint_count(int level) {
  constexpr int counts[] = {1, 18, 71, 94, 146};
  return level < 0 || level > 4 ? 0 : counts[level];
}

namespace {

// Which vertices of a shape a control takes: a side, or a region told by what lids and mouth move.
enum class Cut : uint8_t {
  all,
  left,
  right,
  eyes,
  mouth,
  mouth_left,
  mouth_right,
  rest,
  rest_left,
  rest_right
};

struct Term {
  const char* shape;
  float weight;
};
struct Recipe {
  const char* control;
  Cut cut;
  Term terms[5];
};

// The first recipe of a control whose shapes are all there is taken. VRM has whole expressions and
// five vowels: consonants are small vowels (the viseme table's VRM column), brows and mouths are
// parts of expressions.
const Recipe recipes[] = {
    {"blink_l", Cut::all, {{"eyeBlinkLeft", 1}}},
    {"blink_l", Cut::all, {{"blinkLeft", 1}}},
    {"blink_l", Cut::all, {{"FclEYECloseL", 1}}},
    {"blink_l", Cut::left, {{"blink", 1}}},
    {"blink_r", Cut::all, {{"eyeBlinkRight", 1}}},
    {"blink_r", Cut::all, {{"blinkRight", 1}}},
    {"blink_r", Cut::all, {{"FclEYECloseR", 1}}},
    {"blink_r", Cut::right, {{"blink", 1}}},
    {"lid_wide", Cut::all, {{"eyeWideLeft", 1}, {"eyeWideRight", 1}}},
    {"lid_wide", Cut::eyes, {{"surprised", 1}}},
    {"squint", Cut::all, {{"eyeSquintLeft", 1}, {"eyeSquintRight", 1}}},
    {"squint", Cut::eyes, {{"happy", 0.6f}}},
    {"brow_up_l", Cut::all, {{"browOuterUpLeft", 1}}},
    {"brow_up_l", Cut::rest_left, {{"surprised", 1}}},
    {"brow_up_r", Cut::all, {{"browOuterUpRight", 1}}},
    {"brow_up_r", Cut::rest_right, {{"surprised", 1}}},
    {"brow_inner_up", Cut::all, {{"browInnerUp", 1}}},
    {"brow_inner_up", Cut::rest, {{"sad", 1}}},
    {"brow_down", Cut::all, {{"browDownLeft", 1}, {"browDownRight", 1}}},
    {"brow_down", Cut::rest, {{"angry", 1}}},
    {"smile_l", Cut::all, {{"mouthSmileLeft", 1}}},
    {"smile_l", Cut::left, {{"mouthSmile", 1}}},
    {"smile_l", Cut::mouth_left, {{"happy", 1}}},
    {"smile_r", Cut::all, {{"mouthSmileRight", 1}}},
    {"smile_r", Cut::right, {{"mouthSmile", 1}}},
    {"smile_r", Cut::mouth_right, {{"happy", 1}}},
    {"frown", Cut::all, {{"mouthFrownLeft", 1}, {"mouthFrownRight", 1}}},
    {"frown", Cut::mouth, {{"sad", 1}}},
    {"mouth_open", Cut::all, {{"jawOpen", 1}}},
    {"mouth_open", Cut::all, {{"mouthOpen", 1}}},
    {"mouth_open", Cut::all, {{"aa", 1}}},
    {"lips_pucker", Cut::all, {{"mouthPucker", 1}}},
    {"lips_pucker", Cut::all, {{"ou", 1}}},
    {"lips_wide", Cut::all, {{"mouthStretchLeft", 1}, {"mouthStretchRight", 1}}},
    {"lips_wide", Cut::all, {{"ih", 1}}},
    {"lips_press", Cut::all, {{"mouthPressLeft", 1}, {"mouthPressRight", 1}}},
    {"lips_press", Cut::mouth, {{"angry", 1}}},
    {"upper_lip_up", Cut::all, {{"mouthUpperUpLeft", 1}, {"mouthUpperUpRight", 1}}},
    {"lower_lip_down", Cut::all, {{"mouthLowerDownLeft", 1}, {"mouthLowerDownRight", 1}}},
    {"cheek_puff", Cut::all, {{"cheekPuff", 1}}},
    {"nose_wrinkle", Cut::all, {{"noseSneerLeft", 1}, {"noseSneerRight", 1}}},
    {"viseme_aa", Cut::all, {{"aa", 1}}},
    {"viseme_aa",
     Cut::all,
     {{"jawOpen", 0.65f}, {"mouthLowerDownLeft", 0.3f}, {"mouthLowerDownRight", 0.3f}}},
    {"viseme_aa", Cut::all, {{"jawOpen", 0.65f}}},
    {"viseme_aa", Cut::all, {{"mouthOpen", 0.8f}}},
    {"viseme_E", Cut::all, {{"ee", 0.9f}, {"aa", 0.2f}}},
    {"viseme_E",
     Cut::all,
     {{"jawOpen", 0.35f}, {"mouthStretchLeft", 0.2f}, {"mouthStretchRight", 0.2f}}},
    {"viseme_E", Cut::all, {{"aa", 0.4f}}},
    {"viseme_ih", Cut::all, {{"ih", 1}}},
    {"viseme_ih",
     Cut::all,
     {{"jawOpen", 0.15f},
      {"mouthSmileLeft", 0.3f},
      {"mouthSmileRight", 0.3f},
      {"mouthStretchLeft", 0.3f},
      {"mouthStretchRight", 0.3f}}},
    {"viseme_ih", Cut::all, {{"aa", 0.25f}}},
    {"viseme_oh", Cut::all, {{"oh", 1}}},
    {"viseme_oh", Cut::all, {{"jawOpen", 0.4f}, {"mouthFunnel", 0.55f}}},
    {"viseme_oh", Cut::all, {{"aa", 0.6f}}},
    {"viseme_ou", Cut::all, {{"ou", 1}}},
    {"viseme_ou", Cut::all, {{"jawOpen", 0.15f}, {"mouthPucker", 0.75f}, {"mouthFunnel", 0.2f}}},
    {"viseme_ou", Cut::all, {{"aa", 0.3f}}},
    {"viseme_PP",
     Cut::all,
     {{"mouthPressLeft", 0.5f},
      {"mouthPressRight", 0.5f},
      {"mouthRollLower", 0.3f},
      {"mouthRollUpper", 0.3f}}},
    {"viseme_FF",
     Cut::all,
     {{"mouthRollLower", 0.6f},
      {"mouthUpperUpLeft", 0.2f},
      {"mouthUpperUpRight", 0.2f},
      {"jawOpen", 0.05f}}},
    {"viseme_FF", Cut::all, {{"ih", 0.1f}}},
    {"viseme_TH", Cut::all, {{"jawOpen", 0.12f}, {"tongueOut", 0.35f}}},
    {"viseme_TH", Cut::all, {{"aa", 0.15f}, {"ih", 0.1f}}},
    {"viseme_DD",
     Cut::all,
     {{"jawOpen", 0.1f}, {"mouthStretchLeft", 0.1f}, {"mouthStretchRight", 0.1f}}},
    {"viseme_DD", Cut::all, {{"ih", 0.2f}, {"aa", 0.1f}}},
    {"viseme_kk", Cut::all, {{"jawOpen", 0.18f}}},
    {"viseme_kk", Cut::all, {{"aa", 0.15f}, {"ee", 0.1f}}},
    {"viseme_CH", Cut::all, {{"mouthFunnel", 0.5f}, {"mouthPucker", 0.2f}, {"jawOpen", 0.08f}}},
    {"viseme_CH", Cut::all, {{"ou", 0.3f}, {"ih", 0.1f}}},
    {"viseme_SS",
     Cut::all,
     {{"mouthStretchLeft", 0.25f}, {"mouthStretchRight", 0.25f}, {"jawOpen", 0.04f}}},
    {"viseme_SS", Cut::all, {{"ih", 0.3f}}},
    {"viseme_nn", Cut::all, {{"jawOpen", 0.12f}}},
    {"viseme_nn", Cut::all, {{"ih", 0.15f}, {"aa", 0.1f}}},
    {"viseme_RR", Cut::all, {{"mouthFunnel", 0.25f}, {"jawOpen", 0.12f}}},
    {"viseme_RR", Cut::all, {{"ou", 0.2f}, {"aa", 0.1f}}},
};

// "Wolf3D_Head.eyeBlink_L", "EyeBlinkLeft" -> "eyeblinkleft".
std::string key_of(std::string name) {
  size_t dot = name.rfind('.');
  if (dot != std::string::npos && dot + 1 < name.size()) name.erase(0, dot + 1);
  bool sided = name.size() > 2 && name[name.size() - 2] == '_';
  std::string key;
  for (char c : name)
    if (std::isalnum(static_cast<unsigned char>(c)))
      key += char(std::tolower(static_cast<unsigned char>(c)));
  if (sided && key.rfind("fcl", 0) != 0) {
    if (key.back() == 'l') key += "eft";
    else if (key.back() == 'r') key += "ight";
  }
  return key;
}

struct Face {
  Character& character;
  std::map<std::string, size_t> place;  // by key
  std::unordered_set<uint32_t> eyes, mouth;

  explicit Face(Character& of) : character(of) {
    for (size_t d = 0; d < of.displacers.size(); d++)
      place.emplace(key_of(of.displacers[d].name), d);
    for (const char* shape : {"blink", "blinkLeft", "blinkRight", "eyeBlinkLeft", "eyeBlinkRight"})
      gather(shape, eyes);
    for (const char* shape : {"aa", "ih", "ou", "ee", "oh", "jawOpen", "mouthOpen"})
      gather(shape, mouth);
    for (uint32_t v : eyes) mouth.erase(v);
  }
  void gather(const char* shape, std::unordered_set<uint32_t>& vertices) const {
    auto found = place.find(key_of(shape));
    if (found == place.end()) return;
    const Displacer& displacer = character.displacers[found->second];
    for (size_t i = 0; i < displacer.vertices.size(); i++)
      if (glm::length(displacer.displacements[i]) > 1e-5f) vertices.insert(displacer.vertices[i]);
  }
  bool takes(Cut cut, uint32_t vertex) const {
    float x = character.positions[vertex].x;
    if (cut == Cut::left || cut == Cut::mouth_left || cut == Cut::rest_left) {
      if (x < 0) return false;
    } else if (cut == Cut::right || cut == Cut::mouth_right || cut == Cut::rest_right) {
      if (x >= 0) return false;
    }
    if (cut == Cut::eyes) return eyes.count(vertex) > 0;
    if (cut == Cut::mouth || cut == Cut::mouth_left || cut == Cut::mouth_right)
      return mouth.count(vertex) > 0;
    if (cut >= Cut::rest) return !eyes.count(vertex) && !mouth.count(vertex);
    return true;
  }
  const ExpressionRule* rule_of(size_t displacer) const {
    for (const ExpressionRule& rule : character.expression_rules)
      if (size_t(rule.displacer) == displacer) return &rule;
    return nullptr;
  }
  // What of a shape's effect on materials a control takes: those have no sides and no regions.
  static float share_of(Cut cut) {
    return cut == Cut::all ? 1 : cut == Cut::left || cut == Cut::right ? 0.5f : 0;
  }

  // `changes` and `binary`: what the control does to looks, and whether it is all or nothing.
  bool make(const Recipe& recipe, Displacer& made, std::vector<AppearanceChange>& changes,
            bool& binary) const {
    std::map<uint32_t, vec3> sum;
    binary = false;
    for (const Term& term : recipe.terms) {
      if (!term.shape) break;
      auto found = place.find(key_of(term.shape));
      if (found == place.end()) return false;
      const Displacer& shape = character.displacers[found->second];
      float weight = term.weight, share = share_of(recipe.cut);
      if (const ExpressionRule* rule = rule_of(found->second); rule && rule->binary && share > 0) {
        if (weight <= 0.5f) return false;  // there is no little of it
        weight = 1, binary = true;
      }
      for (size_t i = 0; i < shape.vertices.size(); i++)
        if (takes(recipe.cut, shape.vertices[i]))
          sum[shape.vertices[i]] += shape.displacements[i] * weight;
      for (AppearanceChange change : character.appearance_changes) {
        if (size_t(change.displacer) != found->second || share == 0) continue;
        change.base_color *= weight * share, change.emission *= weight * share,
            change.uv *= weight * share;
        changes.push_back(change);
      }
    }
    if (sum.empty() && changes.empty()) return false;
    made = {recipe.control, {}, {}};
    for (const auto& [vertex, move] : sum) {
      made.vertices.push_back(vertex);
      made.displacements.push_back(move);
    }
    return true;
  }
};

// The group a control or a VRM preset belongs to; -1: none.
int group_of(const std::string& name) {
  static const std::unordered_set<std::string> vowels = {"aa", "ih", "ou", "ee", "oh"};
  if (name.rfind("blink", 0) == 0) return int(ExpressionGroup::blink);
  if (name.rfind("look", 0) == 0) return int(ExpressionGroup::gaze);
  return name.rfind("viseme_", 0) == 0 || vowels.count(name) ? int(ExpressionGroup::mouth) : -1;
}

// Rules for all that is forbidden by some.
void complete_rules(Character& character) {
  auto& rules = character.expression_rules;
  if (rules.empty()) return;
  for (size_t d = 0; d < character.displacers.size(); d++) {
    int group = group_of(character.displacers[d].name);
    if (group < 0) continue;
    auto own = std::find_if(rules.begin(), rules.end(), [&](const ExpressionRule& rule) {
      return size_t(rule.displacer) == d;
    });
    if (own == rules.end()) rules.push_back({int(d), false, group, {}});
    else own->group = group;
  }
}

}  // namespace

void complete_face(Character& character) {
  if (character.displacers.empty()) return;
  Face face(character);
  std::vector<Displacer> made;
  std::vector<AppearanceChange> all_changes;
  std::vector<ExpressionRule> rules;
  std::unordered_set<std::string> done;
  for (const Recipe& recipe : recipes) {
    if (face.place.count(key_of(recipe.control)) || done.count(recipe.control)) continue;
    Displacer displacer;
    std::vector<AppearanceChange> changes;
    bool binary = false;
    if (!face.make(recipe, displacer, changes, binary)) continue;
    done.insert(recipe.control);
    int index = int(character.displacers.size() + made.size());
    for (AppearanceChange& change : changes)
      change.displacer = index, all_changes.push_back(change);
    if (binary) rules.push_back({index, true, -1, {}});
    made.push_back(std::move(displacer));
  }
  for (Displacer& displacer : made) character.displacers.push_back(std::move(displacer));
  character.appearance_changes.insert(character.appearance_changes.end(), all_changes.begin(),
                                      all_changes.end());
  character.expression_rules.insert(character.expression_rules.end(), rules.begin(), rules.end());
  complete_rules(character);
}

}  // namespace wellspring::avatar
