// SPDX-License-Identifier: Apache-2.0
// Reads the JSON of expressions.
#include <algorithm>

#include "avatar/face/expression.h"
#include "avatar/face/library_json.h"
#include "base/read_file.h"

namespace wellspring::avatar {
namespace {

using nlohmann::json;

constexpr const char* kind_names[] = {"plain", "mouth",      "parts_lips",
                                      "blink", "opens_lids", "viseme"};
// Each kind of expression has a list of parts, and each part a field that names what it weights.
constexpr const char* list_names[] = {"rotate", "deform", "group"};
constexpr const char* part_names[] = {"rotator", "control", "expression"};
constexpr double limit = double(largest_expression_weight);

struct Reader : LibraryReader {
  std::vector<std::string> names(const json& entry, const std::string& where,
                                 const char* field) const {
    std::vector<std::string> result;
    const json& given = list(entry, where, field, 64);
    for (size_t i = 0; i < given.size(); i++) {
      if (!given[i].is_string() || given[i].get<std::string>().size() > 200)
        fail(where + "/" + field + "/" + std::to_string(i), "a name is expected");
      result.push_back(given[i].get<std::string>());
    }
    return result;
  }

  template <class Named>
  void not_yet(const std::vector<Named>& known, const std::string& name,
               const std::string& where) const {
    for (const Named& other : known)
      if (other.name == name) fail(where + "/name", "is there twice: " + name);
  }

  Rotator read_rotator(const json& entry, const std::string& where) const {
    only(entry, where, {"name", "joint", "weight_ranges", "orientations"});
    Rotator rotator;
    rotator.name = name(entry, where);
    rotator.joint = name(entry, where, "joint");
    const json& weights = list(entry, where, "weight_ranges", 256);
    const json& turns = list(entry, where, "orientations", 256);
    if (weights.empty()) fail(where + "/weight_ranges", "is missing");
    if (weights.size() != turns.size())
      fail(where + "/orientations", "as many as weight_ranges has are expected");
    for (size_t i = 0; i < weights.size(); i++) {
      std::string place = where + "/weight_ranges/" + std::to_string(i);
      float weight = number(weights[i], place, -limit, limit);
      if (i > 0 && !(weight > rotator.weights.back())) fail(place, "is not above the one before");
      rotator.weights.push_back(weight);
      place = where + "/orientations/" + std::to_string(i);
      if (!turns[i].is_array() || turns[i].size() != 4)
        fail(place, "an axis and an angle, [x, y, z, radians], are expected");
      dvec4 turn(0);
      for (int k = 0; k < 4; k++) {
        const json& value = turns[i][size_t(k)];
        if (!value.is_number() || !(std::abs(value.get<double>()) <= 1e6))
          fail(place + "/" + std::to_string(k), "a number is expected");
        turn[k] = value.get<double>();
      }
      dvec3 axis(turn);
      if (glm::length(axis) < 1e-9 && turn.w != 0) fail(place, "the axis has no direction");
      glm::dquat q(1, 0, 0, 0);
      if (turn.w != 0) q = glm::angleAxis(turn.w, glm::normalize(axis));
      rotator.turns.push_back(turn);
      rotator.orientations.push_back(quat(q));
    }
    return rotator;
  }

  static int find_rotator(const ExpressionSet& set, const std::string& name) {
    for (size_t r = 0; r < set.rotators.size(); r++)
      if (set.rotators[r].name == name) return int(r);
    return -1;
  }

  Control read_control(const json& entry, const std::string& where,
                       const ExpressionSet& set) const {
    only(entry, where, {"name", "kind", "displacers", "shared", "rotator"});
    Control control;
    control.name = name(entry, where);
    if (const json* kind = find(entry, "kind")) {
      auto known = std::find(std::begin(kind_names), std::end(kind_names), *kind);
      if (known == std::end(kind_names)) fail(where + "/kind", "no such kind of control is known");
      control.kind = ControlKind(known - std::begin(kind_names));
    }
    control.displacers = names(entry, where, "displacers");
    control.shared = names(entry, where, "shared");
    if (find(entry, "rotator")) {
      std::string of = name(entry, where, "rotator");
      control.rotator = find_rotator(set, of);
      if (control.rotator < 0) fail(where + "/rotator", "is not known here: " + of);
    }
    return control;
  }

  NamedExpression read_expression(const json& entry, const std::string& where,
                                  const ExpressionSet& set) const {
    only(entry, where, {"name", "about", "rotate", "deform", "group", "otherwise"});
    NamedExpression expression;
    expression.name = name(entry, where);
    if (const json* about = find(entry, "about"); about && about->is_string())
      expression.about = about->get<std::string>();
    int kind = -1;
    for (int k = 0; k < 3; k++) {
      if (!find(entry, list_names[k])) continue;
      if (kind >= 0) fail(where, "has two of rotate, deform and group");
      kind = k;
    }
    if (kind < 0) fail(where, "has none of rotate, deform and group");
    expression.kind = NamedExpression::Kind(kind);
    const json& parts = list(entry, where, list_names[kind], 256);
    for (size_t i = 0; i < parts.size(); i++) {
      std::string place = where + "/" + list_names[kind] + "/" + std::to_string(i);
      only(object(parts[i], place), place, {part_names[kind], "weight"});
      std::string of = name(parts[i], place, part_names[kind]);
      ExpressionPart part;
      part.index = kind == 0   ? find_rotator(set, of)
                   : kind == 1 ? find_control(set, of)
                               : find_expression(set, of);
      if (part.index < 0)
        fail(place + "/" + part_names[kind],
             "is not known here: " + of + (kind == 2 ? " (a group uses earlier expressions)" : ""));
      part.weight = number(parts[i], place, "weight", 1, -limit, limit);
      expression.parts.push_back(part);
    }
    if (find(entry, "otherwise")) {
      std::string of = name(entry, where, "otherwise");
      expression.otherwise = find_expression(set, of);
      if (expression.otherwise < 0) fail(where + "/otherwise", "is not known here: " + of);
    }
    return expression;
  }
};

}  // namespace

ExpressionSet read_expressions(std::string_view text, const std::string& file) {
  Reader reader{{file}};
  json root = reader.parse(text, "wellspring-expressions");
  reader.only(root, "", {"format", "version", "about", "rotators", "controls", "expressions"});
  ExpressionSet set;
  auto each = [&](const char* field, auto&& read) {
    const json& entries = reader.list(root, "", field, most_expressions);
    for (size_t i = 0; i < entries.size(); i++) {
      std::string where = std::string("/") + field + "/" + std::to_string(i);
      read(reader.object(entries[i], where), where);
    }
  };
  each("rotators", [&](const json& entry, const std::string& where) {
    Rotator rotator = reader.read_rotator(entry, where);
    reader.not_yet(set.rotators, rotator.name, where);
    set.rotators.push_back(std::move(rotator));
  });
  each("controls", [&](const json& entry, const std::string& where) {
    Control control = reader.read_control(entry, where, set);
    reader.not_yet(set.controls, control.name, where);
    set.controls.push_back(std::move(control));
  });
  each("expressions", [&](const json& entry, const std::string& where) {
    NamedExpression expression = reader.read_expression(entry, where, set);
    reader.not_yet(set.expressions, expression.name, where);
    set.expressions.push_back(std::move(expression));
  });
  return set;
}

ExpressionSet load_expressions(const std::string& file) {
  return read_expressions(read_file(file, most_library_bytes), file);
}

}  // namespace wellspring::avatar
