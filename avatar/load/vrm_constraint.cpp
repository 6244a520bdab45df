// SPDX-License-Identifier: Apache-2.0
// VRMC_node_constraint-1.0, which nodes of any glTF file may carry.
#include <algorithm>

#include "avatar/load/vrm_extension.h"
#include "avatar/load/vrm_json.h"

namespace wellspring::avatar {
namespace {

using namespace vrm_json;

constexpr size_t constraint_limit = 4096;

struct Axis {
  const char* name;
  vec3 way;
};
constexpr Axis roll_axes[] = {{"X", {1, 0, 0}}, {"Y", {0, 1, 0}}, {"Z", {0, 0, 1}}};
constexpr Axis aim_axes[] = {{"PositiveX", {1, 0, 0}}, {"NegativeX", {-1, 0, 0}},
                             {"PositiveY", {0, 1, 0}}, {"NegativeY", {0, -1, 0}},
                             {"PositiveZ", {0, 0, 1}}, {"NegativeZ", {0, 0, -1}}};

template <size_t count>
vec3 axis_in(const File& file, const json& object, const char* key, const Axis (&axes)[count],
             const std::string& where) {
  std::string name = text_in(object, key);
  for (const Axis& axis : axes)
    if (name == axis.name) return axis.way;
  gltf::refuse(file, where + "/" + key, "'" + name.substr(0, 40) + "' is no axis");
}

}  // namespace

void read_vrm_constraints(File& file, Vrm& vrm) {
  const json& nodes = gltf::items(file.root, "nodes");
  for (size_t n = 0; n < nodes.size(); n++) {
    const json* extension = gltf::extension(nodes[n], "VRMC_node_constraint");
    if (!extension) continue;
    std::string where = at("/nodes", n) + "/extensions/VRMC_node_constraint";
    const json& object = object_in(file, *extension, "constraint", where);
    where += "/constraint";
    VrmConstraint constraint;
    constraint.node = n;
    std::string kind;
    size_t kinds = 0;
    for (const char* known : {"roll", "aim", "rotation"})
      if (gltf::find(object, known)) kind = known, kinds++;
    if (kinds != 1) {
      gltf::warn(file, where, "is not one of roll, aim and rotation: not followed");
      continue;
    }
    const json& asked = object_in(file, object, kind.c_str(), where);
    where += "/" + kind;
    int source = index_in(file, asked, "source", "nodes", where);
    if (source < 0) gltf::refuse(file, where, "has no source");
    constraint.source = size_t(source);
    constraint.weight = std::clamp(number_in(asked, "weight", 1), 0.0f, 1.0f);
    if (kind == "aim") {
      constraint.kind = JointConstraint::Kind::aim;
      constraint.axis = axis_in(file, asked, "aimAxis", aim_axes, where);
    } else if (kind == "roll") {
      constraint.kind = JointConstraint::Kind::roll;
      constraint.axis = axis_in(file, asked, "rollAxis", roll_axes, where);
    }
    if (vrm.constraints.size() == constraint_limit)
      gltf::warn(
          file, "",
          "constraints beyond the first " + std::to_string(constraint_limit) + " are not followed");
    if (vrm.constraints.size() < constraint_limit) vrm.constraints.push_back(constraint);
  }
}

}  // namespace wellspring::avatar
