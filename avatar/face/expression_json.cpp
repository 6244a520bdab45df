// SPDX-License-Identifier: Apache-2.0
// Reads the JSON of expressions.
#include "avatar/face/expression.h"
#include "avatar/face/library_json.h"

namespace wellspring::avatar {
namespace {

// Each kind of expression has a list of parts, and each part a field that names what it weights.
constexpr const char* list_names[] = {"rotate", "deform", "group"};
constexpr const char* part_names[] = {"rotator", "control", "expression"};
constexpr double limit = double(largest_expression_weight);

std::vector<std::string> read_names(FieldReader& entry, const char* field) {
  std::vector<std::string> names;
  for (const JsonValue& one : entry.list(field, 0, 64, "names")) one.text(names.emplace_back());
  return names;
}

// Adds a value that has a name of its own.
template <class Named>
void add_new(std::vector<Named>& known, FieldReader& entry, Named one) {
  for (const Named& other : known)
    if (other.name == one.name) entry.fail("name", "is there twice: " + one.name);
  known.push_back(std::move(one));
}

int find_rotator(const ExpressionSet& set, const std::string& name) {
  for (size_t r = 0; r < set.rotators.size(); r++)
    if (set.rotators[r].name == name) return int(r);
  return -1;
}

// Reads the name of something that is known already; absent ones leave `to` as it is.
template <class Find>
void read_known(FieldReader& entry, const char* field, const ExpressionSet& set, const Find& find,
                int& to, Need need = Need::optional) {
  std::string name;
  if (!entry.name(field, name, "", need)) return;
  to = find(set, name);
  if (to < 0) entry.fail(field, "is not known here (groups use earlier expressions): " + name);
}

Rotator read_rotator(FieldReader& entry) {
  Rotator rotator;
  entry.name("name", rotator.name, "", Need::required);
  entry.name("joint", rotator.joint, "", Need::required);
  const auto weights = entry.list("weight_ranges", 1, 256, "weights", Need::required);
  const auto turns = entry.list("orientations", 0, 256, "turns");
  if (weights.size() != turns.size())
    entry.fail("orientations", "as many as weight_ranges has are expected");
  for (size_t i = 0; i < weights.size(); i++) {
    float weight = 0;
    weights[i].number(-limit, limit, weight);
    if (i > 0 && !(weight > rotator.weights.back())) weights[i].fail("is not above the one before");
    rotator.weights.push_back(weight);
    dvec4 turn(0);  // axis, radians
    turns[i].numbers(4, -1e6, 1e6, &turn.x);
    dvec3 axis(turn);
    if (glm::length(axis) < 1e-9 && turn.w != 0) turns[i].fail("the axis has no direction");
    glm::dquat q(1, 0, 0, 0);
    if (turn.w != 0) q = glm::angleAxis(turn.w, glm::normalize(axis));
    rotator.turns.push_back(turn);
    rotator.orientations.push_back(quat(q));
  }
  return rotator;
}

Control read_control(FieldReader& entry, const ExpressionSet& set) {
  Control control;
  entry.name("name", control.name, "", Need::required);
  entry.choice("kind", {"plain", "mouth", "parts_lips", "blink", "opens_lids", "viseme"},
               control.kind, "");
  control.displacers = read_names(entry, "displacers");
  control.shared = read_names(entry, "shared");
  read_known(entry, "rotator", set, find_rotator, control.rotator);
  return control;
}

NamedExpression read_expression(FieldReader& entry, const ExpressionSet& set) {
  NamedExpression expression;
  entry.name("name", expression.name, "", Need::required);
  entry.text("about", expression.about, "", Need::optional, 4000);
  int kind = -1;
  for (int k = 0; k < 3; k++) {
    if (!entry.find(list_names[k])) continue;
    if (kind >= 0) entry.fail("has two of rotate, deform and group");
    kind = k;
  }
  if (kind < 0) entry.fail("has none of rotate, deform and group");
  expression.kind = NamedExpression::Kind(kind);
  const auto find = [&](const ExpressionSet& all, const std::string& name) {
    return kind == 0   ? find_rotator(all, name)
           : kind == 1 ? find_control(all, name)
                       : find_expression(all, name);
  };
  entry.parts(list_names[kind], 256, "", [&](FieldReader& fields) {
    ExpressionPart part;
    part.weight = 1;
    read_known(fields, part_names[kind], set, find, part.index, Need::required);
    fields.number("weight", -limit, limit, part.weight);
    expression.parts.push_back(part);
  });
  read_known(entry, "otherwise", set, find_expression, expression.otherwise);
  return expression;
}

}  // namespace

ExpressionSet read_expressions(std::string_view text, const std::string& file) {
  const nlohmann::json parsed = parse_json_file(file, text, true);
  Faults faults(file, true);
  FieldReader root(parsed, faults);
  read_library_head(root, "wellspring-expressions");
  ExpressionSet set;
  root.parts("rotators", most_expressions, "",
             [&](FieldReader& entry) { add_new(set.rotators, entry, read_rotator(entry)); });
  root.parts("controls", most_expressions, "",
             [&](FieldReader& entry) { add_new(set.controls, entry, read_control(entry, set)); });
  root.parts("expressions", most_expressions, "", [&](FieldReader& entry) {
    add_new(set.expressions, entry, read_expression(entry, set));
  });
  root.finish();
  return set;
}

ExpressionSet load_expressions(const std::string& file) {
  return read_expressions(read_json_text(file), file);
}

}  // namespace wellspring::avatar
