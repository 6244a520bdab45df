// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>

#include "avatar/load/x3d_node.h"
#include "base/load_error.h"

namespace wellspring::avatar {
namespace {

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == ',' || c == '[' || c == ']';
}

[[noreturn]] void fail(const X3dFile& file, const X3dNode& node, std::string_view field,
                       std::string what) {
  throw LoadError(file.path, where(node), "field '" + std::string(field) + "' " + what);
}

template <class Number, class Parse>
std::vector<Number> numbers(const X3dFile& file, const X3dNode& node, std::string_view name,
                            Parse parse) {
  std::vector<Number> result;
  const std::string* text = find_field(node, name);
  if (!text) return result;
  const char* p = text->data();
  const char* end = p + text->size();
  while (true) {
    while (p < end && is_space(*p)) p++;
    if (p == end) return result;
    Number value{};
    const char* stop = parse(p, end, value);
    if (!stop || (stop < end && !is_space(*stop))) {
      const char* word = p;
      while (word < end && !is_space(*word)) word++;
      fail(file, node, name,
           "holds '" + std::string(p, std::min<ptrdiff_t>(word - p, 40)) +
               "', which is no finite number");
    }
    result.push_back(value);
    p = stop;
  }
}

std::string trimmed(std::string_view text) {
  auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return std::string(text);
}

}  // namespace

std::string where(const X3dNode& node) {
  std::string name = string_of(node, "name");
  if (name.empty()) name = node.def;
  std::string text = node.line > 0 ? "line " + std::to_string(node.line) + " (" : "(";
  return text + node.type + (name.empty() ? "" : " " + name.substr(0, 60)) + ")";
}

void add_route(X3dFile& file, X3dRoute route) {
  if (file.routes.size() < x3d_max_routes) file.routes.push_back(std::move(route));
  else warn_once(file.warnings, "too many ROUTEs: the rest is left out");
}

void warn_once(std::vector<std::string>& warnings, const std::string& text) {
  constexpr size_t most = 100;
  if (warnings.size() > most) return;
  if (std::find(warnings.begin(), warnings.end(), text) != warnings.end()) return;
  warnings.push_back(warnings.size() < most ? text : "more warnings than these are left out");
}

const std::string* find_field(const X3dNode& node, std::string_view name) {
  for (const X3dField& field : node.fields)
    if (field.name == name) return &field.text;
  return nullptr;
}

std::vector<float> floats_of(const X3dFile& file, const X3dNode& node, std::string_view name) {
  return numbers<float>(file, node, name,
                        [](const char* p, const char* end, float& value) -> const char* {
                          if (*p == '+') p++;
                          double wide = 0;  // so that 1e-60 reads as 0 instead of an error
                          auto [stop, error] = std::from_chars(p, end, wide);
                          if (error == std::errc::result_out_of_range)
                            wide = std::abs(wide) < 1 ? 0 : INFINITY;
                          else if (error != std::errc()) return nullptr;
                          value = float(wide);
                          return std::isfinite(value) ? stop : nullptr;
                        });
}

std::vector<int> ints_of(const X3dFile& file, const X3dNode& node, std::string_view name) {
  return numbers<int>(file, node, name,
                      [](const char* p, const char* end, int& value) -> const char* {
                        if (*p == '+') p++;
                        auto [stop, error] = std::from_chars(p, end, value);
                        return error == std::errc() ? stop : nullptr;
                      });
}

float float_of(const X3dFile& file, const X3dNode& node, std::string_view name, float otherwise) {
  auto v = floats_of(file, node, name);
  return v.empty() ? otherwise : v[0];
}

vec3 vec3_of(const X3dFile& file, const X3dNode& node, std::string_view name, vec3 otherwise) {
  auto v = floats_of(file, node, name);
  if (v.empty()) return otherwise;
  if (v.size() < 3) fail(file, node, name, "needs 3 numbers");
  return {v[0], v[1], v[2]};
}

quat rotation_of(const X3dFile& file, const X3dNode& node, std::string_view name) {
  auto v = floats_of(file, node, name);
  if (v.empty()) return quat(1, 0, 0, 0);
  if (v.size() < 4) fail(file, node, name, "needs 4 numbers");
  vec3 axis(v[0], v[1], v[2]);
  float length = glm::length(axis);
  if (length < 1e-12f || !std::isfinite(length)) return quat(1, 0, 0, 0);
  return glm::angleAxis(v[3], axis / length);
}

bool bool_of(const X3dNode& node, std::string_view name, bool otherwise) {
  const std::string* text = find_field(node, name);
  if (!text) return otherwise;
  std::string value = trimmed(*text);
  if (value == "true" || value == "TRUE" || value == "1") return true;
  if (value == "false" || value == "FALSE" || value == "0") return false;
  return otherwise;
}

std::string string_of(const X3dNode& node, std::string_view name) {
  const std::string* text = find_field(node, name);
  if (!text) return "";
  std::string value = trimmed(*text);
  if (value.size() < 2 || value.front() != '"' || value.back() != '"') return value;
  std::string plain;
  for (size_t i = 1; i + 1 < value.size(); i++) {
    if (value[i] == '\\' && i + 2 < value.size()) i++;
    plain += value[i];
  }
  return trimmed(plain);
}

std::vector<std::string> strings_of(const X3dNode& node, std::string_view name) {
  std::vector<std::string> result;
  const std::string* text = find_field(node, name);
  if (!text) return result;
  const std::string& s = *text;
  if (s.find('"') == std::string::npos) {  // a common slip: one string without its quotes
    std::string all = trimmed(s);
    if (!all.empty()) result.push_back(all);
    return result;
  }
  for (size_t i = 0; i < s.size(); i++) {
    if (s[i] != '"') continue;
    std::string value;
    for (i++; i < s.size() && s[i] != '"'; i++) {
      if (s[i] == '\\' && i + 1 < s.size()) i++;
      value += s[i];
    }
    result.push_back(value);
  }
  return result;
}

std::vector<vec3> points_of(const X3dFile& file, const X3dNode& node, std::string_view name) {
  auto v = floats_of(file, node, name);
  std::vector<vec3> points(v.size() / 3);
  for (size_t i = 0; i < points.size(); i++) points[i] = {v[3 * i], v[3 * i + 1], v[3 * i + 2]};
  return points;
}

int find_child(const X3dFile& file, const X3dNode& node, std::string_view field,
               std::initializer_list<std::string_view> types) {
  for (const X3dChild& child : node.children) {
    if (!field.empty() && child.field == field) return child.node;
    const std::string& type = file.nodes[size_t(child.node)].type;
    bool right_type = std::find(types.begin(), types.end(), type) != types.end();
    if (right_type && (child.field.empty() || field.empty() || child.field == "children"))
      return child.node;
  }
  return -1;
}

mat4 transform_of(const X3dFile& file, const X3dNode& node) {
  vec3 translation = vec3_of(file, node, "translation", vec3(0));
  vec3 center = vec3_of(file, node, "center", vec3(0));
  vec3 scale = vec3_of(file, node, "scale", vec3(1));
  mat4 matrix = glm::translate(mat4(1), translation + center);
  matrix = matrix * glm::mat4_cast(rotation_of(file, node, "rotation"));
  if (scale != vec3(1)) {
    mat4 orientation = glm::mat4_cast(rotation_of(file, node, "scaleOrientation"));
    matrix = matrix * orientation * glm::scale(mat4(1), scale) * glm::transpose(orientation);
  }
  return glm::translate(matrix, -center);
}

}  // namespace wellspring::avatar
