// SPDX-License-Identifier: Apache-2.0
#include "avatar/figure/face_names.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <nlohmann/json.hpp>
#include <unordered_set>

#include "base/load_error.h"

namespace wellspring::avatar {

namespace {

// Says which vertices of a shape a control takes: a side, or a region given by what lids and mouth
// move.
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

struct Recipe {
  std::string control;
  Cut cut = Cut::all;
  std::vector<std::pair<std::string, float>> terms;  // shapes and their weights
};

// The first recipe of a control whose shapes are all there is taken. VRM has whole expressions and
// five vowels: consonants are small vowels (the viseme table's VRM column), brows and mouths are
// parts of expressions.
const std::vector<Recipe>& face_recipes() {
  static const std::vector<Recipe> recipes = [] {
    constexpr std::string_view regions[] = {"all",       "left",       "right",       "eyes",
                                            "mouth",     "mouth_left", "mouth_right", "rest",
                                            "rest_left", "rest_right"};
    std::vector<Recipe> made;
    const auto table = nlohmann::ordered_json::parse(face_shapes_json());
    for (const auto& one : table.at("recipes")) {
      const std::string region = one.at("region");
      const auto found = std::find(std::begin(regions), std::end(regions), region);
      if (found == std::end(regions)) throw LoadError("face_shapes.json", "/recipes", region);
      Recipe& recipe = made.emplace_back();
      recipe.control = one.at("control"), recipe.cut = Cut(found - std::begin(regions));
      for (const auto& [shape, weight] : one.at("shapes").items())
        recipe.terms.emplace_back(shape, weight);
    }
    return made;
  }();
  return recipes;
}

// Makes the key of a name: "Wolf3D_Head.eyeBlink_L", "EyeBlinkLeft" -> "eyeblinkleft".
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
  // Returns the share of a shape's effect on materials that a control takes: materials have no
  // sides and no regions.
  static float share_of(Cut cut) {
    return cut == Cut::all ? 1 : cut == Cut::left || cut == Cut::right ? 0.5f : 0;
  }

  // Makes a displacer. `changes` and `binary` say what the control does to looks, and whether it is
  // all or nothing.
  bool make(const Recipe& recipe, Displacer& made, std::vector<AppearanceChange>& changes,
            bool& binary) const {
    std::map<uint32_t, vec3> sum;
    binary = false;
    for (const auto& [name, part] : recipe.terms) {
      auto found = place.find(key_of(name));
      if (found == place.end()) return false;
      const Displacer& shape = character.displacers[found->second];
      float weight = part, share = share_of(recipe.cut);
      if (const ExpressionRule* rule = rule_of(found->second); rule && rule->binary && share > 0) {
        if (weight <= 0.5f) return false;  // an all-or-nothing shape cannot show a little
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

// Returns the group a control or a VRM preset belongs to; -1: none.
int group_of(const std::string& name) {
  static const std::unordered_set<std::string> vowels = {"aa", "ih", "ou", "ee", "oh"};
  if (name.rfind("blink", 0) == 0) return int(ExpressionGroup::blink);
  if (name.rfind("look", 0) == 0) return int(ExpressionGroup::gaze);
  return name.rfind("viseme_", 0) == 0 || vowels.count(name) ? int(ExpressionGroup::mouth) : -1;
}

// Adds rules for all that is forbidden by some.
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
  for (const Recipe& recipe : face_recipes()) {
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
