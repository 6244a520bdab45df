// SPDX-License-Identifier: Apache-2.0
#include "avatar/load/x3d_node.h"

#include <algorithm>
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

// Depth-first with a stack of our own: colours 0 unseen, 1 open, 2 done.
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
  std::vector<std::pair<int, size_t>> unknown;  // to be taken out
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

// Something of these is read, a warning says why not, or a figure has no use for them.
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

}  // namespace wellspring::avatar
