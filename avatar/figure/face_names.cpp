// SPDX-License-Identifier: Apache-2.0
#include "avatar/figure/face_names.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <unordered_set>

namespace wellspring::avatar {
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
