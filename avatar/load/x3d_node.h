// SPDX-License-Identifier: Apache-2.0
// Holds an X3D or VRML file as a plain tree of nodes, whatever its encoding. The parsers
// (x3d_xml.cpp, ...) fill it; x3d_humanoid.cpp reads it. Values stay text until somebody asks for
// them by type.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/vec.h"

namespace wellspring::avatar {

struct X3dField {
  std::string name, text;  // text as in the file, lists without their brackets
};

struct X3dChild {
  std::string field;  // the parent's field that holds it; empty: the default one of its type
  int node = 0;       // index into X3dFile::nodes; several parents may share one (DEF/USE)
  bool use = false;   // written as USE
};

struct X3dNode {
  std::string type;  // X3D 4 name: "HAnimJoint" also where the file says "Joint" (H-Anim 1) or a
                     // PROTO of it
  std::string def;
  int line = 0;  // 0: unknown
  std::vector<X3dField> fields;
  std::vector<X3dChild> children;
};

struct X3dRoute {
  std::string from_node, from_field, to_node, to_field;
};

struct X3dFile {
  std::string path;
  std::vector<X3dNode> nodes;  // nodes[0] is the scene; no cycles
  std::vector<X3dRoute> routes;
  float length_unit = 1;  // metres
  std::vector<std::string> warnings;
};

// Limits of a file; beyond them the parsers throw.
inline constexpr size_t x3d_max_bytes = size_t(128) << 20;
inline constexpr int x3d_max_nodes = 500'000;
inline constexpr int x3d_max_depth = 400;
inline constexpr size_t x3d_max_routes = 200'000;

// Parses `text` (the content of `path`), whichever encoding it is in. Throws LoadError with the
// line.
X3dFile parse_x3d(const std::string& path, const std::string& text);
X3dFile parse_x3d_xml(const std::string& path, const std::string& text);
X3dFile parse_x3d_classic(const std::string& path,
                          const std::string& text);  // ClassicVRML and VRML97
X3dFile parse_x3d_json(const std::string& path, const std::string& text);

// Names a type for the parsers: "Joint" -> "HAnimJoint", "x3d:Shape" -> "Shape".
std::string x3d_type_name(std::string_view name);
// This is a USE that a parser has met: its child has only a name until all nodes are read.
// resolve_uses finds the nodes (an unknown name is a warning and the child goes) and throws
// LoadError if they make a cycle.
struct X3dPendingUse {
  int parent = 0;
  size_t child = 0;
  std::string name;
  int line = 0;
};
void resolve_uses(X3dFile& file, const std::vector<X3dPendingUse>& pending);

// Adds one more ROUTE for the parsers; beyond the limit they are dropped with a warning.
void add_route(X3dFile& file, X3dRoute route);

// Adds a warning unless it is there already; after 100 the rest is only counted once as "and more".
void warn_once(std::vector<std::string>& warnings, const std::string& text);

std::string where(const X3dNode& node);  // "line 12 (HAnimJoint l_hip)"

// Return values of a node's field; nothing if the field is absent. Throw LoadError if it is
// malformed, has a number that is not finite or has too few of them.
const std::string* find_field(const X3dNode& node, std::string_view name);
std::vector<float> floats_of(const X3dFile& file, const X3dNode& node, std::string_view name);
std::vector<int> ints_of(const X3dFile& file, const X3dNode& node, std::string_view name);
float float_of(const X3dFile& file, const X3dNode& node, std::string_view name, float otherwise);
vec3 vec3_of(const X3dFile& file, const X3dNode& node, std::string_view name, vec3 otherwise);
quat rotation_of(const X3dFile& file, const X3dNode& node,
                 std::string_view name);  // identity if absent
bool bool_of(const X3dNode& node, std::string_view name, bool otherwise);
std::string string_of(const X3dNode& node, std::string_view name);  // trimmed, unquoted
std::vector<std::string> strings_of(const X3dNode& node, std::string_view name);
std::vector<vec3> points_of(const X3dFile& file, const X3dNode& node, std::string_view name);

// Returns the first child in one of these fields (an empty field name matches the default) or of
// one of these types.
int find_child(const X3dFile& file, const X3dNode& node, std::string_view field,
               std::initializer_list<std::string_view> types);

// Returns translation * center * rotation * scaleOrientation * scale * ... of Transform,
// HAnimJoint, HAnimSite, HAnimHumanoid (X3D 4, 10.4.4).
mat4 transform_of(const X3dFile& file, const X3dNode& node);

bool is_x3d_group(const std::string& type);

// Returns the children of a group that are shown: a Switch's chosen one, an LOD's first level; none
// of a node that is not visible. Metadata are no children.
std::vector<int> shown_children(const X3dFile& file, const X3dNode& node);

// Warns once of all that is no part of a figure: counts, by kind, the nodes that are not read at
// all (lights, sensors, lines, ...), and the shapes that stand beside all humanoids.
void note_left_out(X3dFile& file);

}  // namespace wellspring::avatar
