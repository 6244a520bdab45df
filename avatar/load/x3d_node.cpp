// SPDX-License-Identifier: Apache-2.0
#include "avatar/load/x3d_node.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <map>
#include <unordered_map>
#include <utility>

#include "base/load_error.h"

namespace wellspring::avatar {

std::string x3d_type_name(std::string_view name) {
  size_t colon = name.rfind(':');
  if (colon != std::string_view::npos) name.remove_prefix(colon + 1);
  for (std::string_view old : {"Humanoid", "Joint", "Segment", "Site", "Displacer"})
    if (name == old) return "HAnim" + std::string(name);
  return std::string(name);
}

namespace {

// Searches for cycles depth-first with a stack of our own: colours 0 unseen, 1 open, 2 done.
void refuse_cycles(const X3dFile& file) {
  std::vector<uint8_t> color(file.nodes.size(), 0);
  struct Open {
    int node;
    size_t next;
  };
  std::vector<Open> stack;
  for (size_t start = 0; start < file.nodes.size(); start++) {
    if (color[start]) continue;
    stack.push_back({int(start), 0});
    color[start] = 1;
    while (!stack.empty()) {
      Open& top = stack.back();
      const X3dNode& node = file.nodes[size_t(top.node)];
      if (top.next == node.children.size()) {
        color[size_t(top.node)] = 2;
        stack.pop_back();
        continue;
      }
      const X3dChild& child = node.children[top.next++];
      uint8_t& seen = color[size_t(child.node)];
      if (seen == 1)
        throw LoadError(
            file.path, where(node),
            "USE of '" + file.nodes[size_t(child.node)].def + "' puts a node inside itself");
      if (seen == 0) {
        seen = 1;
        stack.push_back({child.node, 0});
      }
    }
  }
}

}  // namespace

X3dFile parse_x3d(const std::string& path, const std::string& text) {
  size_t start = text.rfind("\xef\xbb\xbf", 0) == 0 ? 3 : 0;
  while (start < text.size() && std::strchr(" \t\r\n", text[start]) && text[start]) start++;
  bool wide = text.size() >= 2 && (text.substr(0, 4).find('\0') != std::string::npos);
  if (wide || (start < text.size() && text[start] == '<')) return parse_x3d_xml(path, text);
  if (start < text.size() && text[start] == '{') return parse_x3d_json(path, text);
  std::string_view head = std::string_view(text).substr(start, 20);
  if (head.rfind("#X3D", 0) == 0 || head.rfind("#VRML V2", 0) == 0)
    return parse_x3d_classic(path, text);
  if (head.rfind("#VRML V1", 0) == 0)
    throw LoadError(path, "line 1", "is VRML 1, which knows no H-Anim");
  throw LoadError(path, "", "is no X3D (XML, ClassicVRML, JSON) and no VRML 97");
}

void resolve_uses(X3dFile& file, const std::vector<X3dPendingUse>& pending) {
  if (pending.empty()) return;
  // A name may be defined again: a USE means the nearest definition before it, else the first one
  // after.
  std::unordered_map<std::string, std::vector<int>> defined;  // ascending node indices
  for (size_t i = 0; i < file.nodes.size(); i++)
    if (!file.nodes[i].def.empty()) defined[file.nodes[i].def].push_back(int(i));
  std::vector<std::pair<int, size_t>> unknown;  // children to be taken out
  for (const X3dPendingUse& use : pending) {
    auto found = defined.find(use.name);
    X3dChild& child = file.nodes[size_t(use.parent)].children[use.child];
    if (file.nodes[size_t(use.parent)].type ==
        "Script") {  // a script may well hold itself; it has no surface
      unknown.push_back({use.parent, use.child});
      continue;
    }
    if (found == defined.end()) {
      warn_once(file.warnings, "line " + std::to_string(use.line) + ": USE of '" +
                                   use.name.substr(0, 60) + "', which is defined nowhere");
      unknown.push_back({use.parent, use.child});
      continue;
    }
    const std::vector<int>& places = found->second;
    auto after = std::upper_bound(places.begin(), places.end(), child.node);
    child.node = after == places.begin() ? places.front() : *(after - 1);
    child.use = true;
  }
  std::sort(unknown.rbegin(), unknown.rend());
  for (auto [parent, index] : unknown) {
    auto& children = file.nodes[size_t(parent)].children;
    children.erase(children.begin() + ptrdiff_t(index));
  }
  refuse_cycles(file);
}

namespace {

constexpr std::string_view groups[] = {
    "Transform", "Group",    "StaticGroup", "Anchor",  "Collision", "Billboard", "LOD",
    "Switch",    "CADLayer", "CADAssembly", "CADPart", "Layer",     "LayerSet",  "ScreenGroup"};

// Parts of these are read, or a warning says why not, or a figure has no use for them.
constexpr std::string_view known[] = {"Scene",
                                      "WorldInfo",
                                      "NavigationInfo",
                                      "Shape",
                                      "Appearance",
                                      "Material",
                                      "PhysicalMaterial",
                                      "UnlitMaterial",
                                      "TwoSidedMaterial",
                                      "ImageTexture",
                                      "PixelTexture",
                                      "MovieTexture",
                                      "MultiTexture",
                                      "TextureTransform",
                                      "TextureCoordinate",
                                      "TextureCoordinateGenerator",
                                      "MultiTextureCoordinate",
                                      "Coordinate",
                                      "CoordinateDouble",
                                      "Normal",
                                      "Color",
                                      "ColorRGBA",
                                      "Box",
                                      "Sphere",
                                      "Cylinder",
                                      "Cone",
                                      "IndexedFaceSet",
                                      "IndexedTriangleSet",
                                      "TriangleSet",
                                      "IndexedTriangleStripSet",
                                      "TriangleStripSet",
                                      "IndexedTriangleFanSet",
                                      "TriangleFanSet",
                                      "IndexedQuadSet",
                                      "QuadSet",
                                      "TimeSensor",
                                      "OrientationInterpolator",
                                      "PositionInterpolator",
                                      "ScalarInterpolator",
                                      "SplinePositionInterpolator",
                                      "SplineScalarInterpolator",
                                      "SquadOrientationInterpolator"};

template <size_t count>
bool is_one_of(const std::string& type, const std::string_view (&names)[count]) {
  return std::find(std::begin(names), std::end(names), type) != std::end(names);
}

size_t count_shapes_outside(const X3dFile& file) {
  size_t shapes = 0;
  std::vector<int> open{0};
  std::vector<uint8_t> seen(file.nodes.size(), 0);
  while (!open.empty()) {
    const int index = open.back();
    open.pop_back();
    const X3dNode& node = file.nodes[size_t(index)];
    if (std::exchange(seen[size_t(index)], 1) || node.type == "HAnimHumanoid") continue;
    shapes += node.type == "Shape";
    for (int child : shown_children(file, node)) open.push_back(child);
  }
  return shapes;
}

}  // namespace

bool is_x3d_group(const std::string& type) { return is_one_of(type, groups); }

std::vector<int> shown_children(const X3dFile& file, const X3dNode& node) {
  if (!bool_of(node, "visible", true)) return {};
  std::vector<int> children;
  for (const X3dChild& child : node.children)
    if (file.nodes[size_t(child.node)].type.rfind("Metadata", 0) != 0)
      children.push_back(child.node);
  if (node.type == "LOD" && children.size() > 1) children.resize(1);
  if (node.type == "Switch") {
    const std::vector<int> choice = ints_of(file, node, "whichChoice");
    const bool shows = !choice.empty() && choice[0] >= 0 && size_t(choice[0]) < children.size();
    return shows ? std::vector<int>{children[size_t(choice[0])]} : std::vector<int>{};
  }
  return children;
}

void note_left_out(X3dFile& file) {
  std::map<std::string, size_t> kinds;
  for (const X3dNode& node : file.nodes) {
    const bool read = node.type.rfind("HAnim", 0) == 0 || node.type.rfind("Metadata", 0) == 0 ||
                      is_x3d_group(node.type) || is_one_of(node.type, known);
    if (!read) kinds[node.type.substr(0, 60)]++;
  }
  std::string list;
  for (const auto& [kind, count] : kinds)
    if (list.size() < 400) list += (list.empty() ? "" : ", ") + std::to_string(count) + " " + kind;
    else if (!list.ends_with("...")) list += ", ...";
  if (!list.empty()) warn_once(file.warnings, "left out, as a figure has none of them: " + list);
  if (size_t shapes = count_shapes_outside(file))
    warn_once(file.warnings,
              std::to_string(shapes) + (shapes == 1 ? " shape stands" : " shapes stand") +
                  " beside the humanoid and " + (shapes == 1 ? "is" : "are") + " left out");
}

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
                          double wide = 0;  // lets 1e-60 read as 0 instead of an error
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
