// SPDX-License-Identifier: Apache-2.0
#include "avatar/load/x3d_humanoid.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "avatar/figure/figure_check.h"
#include "avatar/figure/hanim_names.h"
#include "avatar/load/x3d_motion.h"
#include "avatar/load/x3d_reader.h"
#include "base/load_error.h"

namespace wellspring::avatar {
namespace {

constexpr int max_visits = 2'000'000;

// Walks in preorder without recursion, each node once, and calls found(node, matrix) for each
// HAnimHumanoid. `shown`: only for those that the file's Switch nodes show.
template <class Found>
void find_humanoids(const X3dFile& file, bool shown, const Found& found) {
  struct Item {
    int node;
    mat4 matrix;
  };
  std::vector<Item> stack{{0, mat4(1)}};
  std::vector<uint8_t> seen(file.nodes.size(), 0);
  while (!stack.empty()) {
    Item item = stack.back();
    stack.pop_back();
    if (std::exchange(seen[size_t(item.node)], 1)) continue;
    const X3dNode& node = file.nodes[size_t(item.node)];
    if (node.type == "HAnimHumanoid") {
      if (!found(item.node, item.matrix)) return;
      continue;
    }
    mat4 matrix = node.type == "Transform" ? item.matrix * transform_of(file, node) : item.matrix;
    std::vector<int> children;
    if (shown) children = shown_children(file, node);
    else
      for (const X3dChild& child : node.children) children.push_back(child.node);
    for (size_t i = children.size(); i-- > 0;) stack.push_back({children[i], matrix});
  }
}

std::string node_name(const X3dNode& node) {
  std::string name = string_of(node, "name");
  return name.empty() ? node.def : name;
}

// Returns the part of a joint's transform that is no pose.
mat4 joint_scale(const X3dFile& file, const X3dNode& node) {
  vec3 scale = vec3_of(file, node, "scale", vec3(1));
  if (scale == vec3(1)) return mat4(1);
  vec3 center = vec3_of(file, node, "center", vec3(0));
  mat4 orientation = glm::mat4_cast(rotation_of(file, node, "scaleOrientation"));
  mat4 matrix = glm::translate(mat4(1), center) * orientation * glm::scale(mat4(1), scale);
  return glm::translate(matrix * glm::transpose(orientation), -center);
}

}  // namespace

void HumanoidReader::walk_children(int index, const Context& context) {
  for (size_t i = 0; i < file.nodes[size_t(index)].children.size(); i++) {
    const X3dChild child = file.nodes[size_t(index)].children[i];
    bool elsewhere =
        false;  // lists of USEs and nodes that are no part of the scene graph below this one
    for (const char* field :
         {"joints", "segments", "sites", "viewpoints", "displacers", "skin", "skinCoord",
          "skinNormal", "motions", "metadata", "coord", "skinBindingCoords"})
      elsewhere = elsewhere || child.field == field;
    if (!elsewhere) walk(child.node, context);
  }
}

void HumanoidReader::walk(int index, const Context& context) {
  const X3dNode& node = file.nodes[size_t(index)];
  if (!bool_of(node, "visible", true)) return;
  if (++visits > max_visits || depth > 2 * x3d_max_depth)
    throw LoadError(file.path, where(node), "DEF and USE unfold to too large a tree");
  depth++;
  if (node.type == "HAnimJoint") {
    read_joint(index, context);
  } else if (node.type == "HAnimSegment") {
    read_segment(index, context);
  } else if (node.type == "HAnimSite") {
    Context inner = context;
    inner.matrix = context.matrix * transform_of(file, node);
    if (context.joint >= 0)
      character.sites.push_back({node_name(node), context.joint, vec3(inner.matrix[3])});
    walk_children(index, inner);
  } else if (node.type == "Shape") {
    add_shape(index, context.matrix, context.joint, nullptr);
  } else if (node.type == "Transform") {
    Context inner = context;
    inner.matrix = context.matrix * transform_of(file, node);
    walk_children(index, inner);
  } else if (node.type == "LOD" || node.type == "Switch") {
    for (int child : shown_children(file, node)) walk(child, context);
  } else if (is_x3d_group(node.type)) {
    walk_children(index, context);
  }
  depth--;
}

void HumanoidReader::read_joint(int index, Context context) {
  const X3dNode& node = file.nodes[size_t(index)];
  if (!seen_joints.insert(index).second) {
    warn_once(file.warnings, where(node) + ": is in the skeleton twice, used once");
    return;
  }
  if (character.joints.size() >= size_t(max_joints))
    throw LoadError(file.path, where(node), "more than " + std::to_string(max_joints) + " joints");
  Joint joint;
  std::string written = node_name(node);
  joint.name = hanim_joint_name(written);
  if (joint.name.empty() && !node.def.empty()) joint.name = hanim_joint_name(node.def);
  if (joint.name.empty()) {
    joint.name = written;
    warn_once(file.warnings, "joint name '" + written.substr(0, 60) + "' is not one of H-Anim");
  }
  if (find_joint(character, joint.name) >= 0) {
    warn_once(file.warnings,
              where(node) + ": second joint of the name " + joint.name.substr(0, 60));
    joint.name = written + "_" + std::to_string(character.joints.size());
  }
  joint.parent = context.joint;
  context.matrix = context.matrix * joint_scale(file, node);
  joint.center = vec3(context.matrix * vec4(vec3_of(file, node, "center", vec3(0)), 1));
  joint.rest_rotation = rotation_of(file, node, "rotation");
  if (std::abs(joint.rest_rotation.w) < 0.9999f ||
      vec3_of(file, node, "translation", vec3(0)) != vec3(0))
    warn_once(file.warnings, "the file poses the figure: rest is the H-Anim default pose instead");
  if (!is_finite(joint.center))
    throw LoadError(file.path, where(node), "its place is beyond all numbers");
  std::vector<float> low = floats_of(file, node, "llimit"), high = floats_of(file, node, "ulimit");
  if (low.size() >= 3 && high.size() >= 3)
    for (size_t i = 0; i < 3; i++) joint.limits.push_back({low[i], high[i]});
  joint.limit_orientation = rotation_of(file, node, "limitOrientation");
  if (auto stiffness = floats_of(file, node, "stiffness"); stiffness.size() >= 3)
    joint.stiffness = {stiffness[0], stiffness[1], stiffness[2]};
  context.joint = int(character.joints.size());
  character.joints.push_back(std::move(joint));
  rest.push_back(context.matrix);
  joint_node.push_back(index);
  walk_children(index, context);
}

void HumanoidReader::read_segment(int index, Context context) {
  const X3dNode& node = file.nodes[size_t(index)];
  if (context.joint < 0) {
    warn_once(file.warnings, where(node) + ": belongs to no joint, left out");
    return;
  }
  character.segments.push_back({node_name(node), context.joint});
  auto outer = std::move(placed);
  placed.clear();
  walk_children(index, context);
  int coordinate = find_child(file, node, "coord", {"Coordinate", "CoordinateDouble"});
  if (coordinate < 0 && !placed.empty()) coordinate = placed[0].coordinate;
  add_displacers(index, mat4(1), coordinate);
  placed = std::move(outer);
}

void HumanoidReader::read_skeleton(int humanoid) {
  const std::vector<X3dChild> children = file.nodes[size_t(humanoid)].children;
  Context context{root, -1, -1};
  auto type_of = [&](const X3dChild& child) -> const std::string& {
    return file.nodes[size_t(child.node)].type;
  };
  auto walk_roots = [&](auto&& wanted) {
    for (const X3dChild& child : children)
      if (wanted(child)) walk(child.node, context);
    return !character.joints.empty();
  };
  if (walk_roots([](const X3dChild& child) { return child.field == "skeleton"; })) return;
  // Some files forget the field: a joint's default field is "children".
  if (walk_roots([&](const X3dChild& child) {
        bool anywhere =
            child.field.empty() || child.field == "children" || child.field == "humanoidBody";
        return anywhere && (type_of(child) == "HAnimJoint" || is_x3d_group(type_of(child))) &&
               !child.use;
      }))
    return;
  // If there is only a flat list, its joints that no other joint of it contains are roots.
  std::unordered_set<int> inside;
  std::vector<int> open;
  for (const X3dChild& child : children)
    if (type_of(child) == "HAnimJoint") open.push_back(child.node);
  while (!open.empty()) {
    int index = open.back();
    open.pop_back();
    for (const X3dChild& child : file.nodes[size_t(index)].children)
      if (inside.insert(child.node).second) open.push_back(child.node);
  }
  walk_roots([&](const X3dChild& child) {
    return type_of(child) == "HAnimJoint" && !inside.count(child.node) &&
           !seen_joints.count(child.node);
  });
  if (!character.joints.empty())
    warn_once(file.warnings, "the humanoid has no skeleton field: its list of joints is used");
}

Character character_from_x3d(X3dFile& file) {
  int humanoid = -1, count = 0;
  mat4 above(1);
  auto take = [&](int node, const mat4& matrix) {
    if (count++ == 0) humanoid = node, above = matrix;
    return count < 2;
  };
  find_humanoids(file, true, take);
  if (humanoid < 0) {
    find_humanoids(file, false, take);
    if (humanoid >= 0)
      warn_once(file.warnings, "the file shows no HAnimHumanoid: the first that it hides is used");
  }
  if (humanoid < 0) throw LoadError(file.path, "", "no HAnimHumanoid in the file");
  if (count > 1) warn_once(file.warnings, "only the first HAnimHumanoid of the file is used");
  const X3dNode& node = file.nodes[size_t(humanoid)];

  HumanoidReader reader(file);
  // The exhibit says where the figure stands; the file says how large it is and which way is up.
  above[3] = vec4(0, 0, 0, 1);
  mat4 own = transform_of(file, node);
  own = glm::translate(mat4(1), -vec3_of(file, node, "translation", vec3(0))) * own;
  reader.root = glm::scale(mat4(1), vec3(file.length_unit)) * above * own;
  Character& character = reader.character;
  character.name = node_name(node);
  reader.read_skeleton(humanoid);
  if (character.joints.empty())
    throw LoadError(file.path, where(node), "the humanoid has no joints");
  reader.read_skin(humanoid);

  read_x3d_motions(reader, humanoid);
  for (const X3dNode& data : file.nodes)
    if (data.type == "MetadataString" && string_of(data, "name") == "skinning" &&
        string_of(data, "value") == "dual_quaternion")
      character.skinning = Skinning::dual_quaternion;
  std::vector<std::string_view> names;
  for (const Joint& joint : character.joints) names.push_back(joint.name);
  character.loa = level_of_articulation(names);
  std::vector<int> said = ints_of(file, node, "loa");
  if (!said.empty() && said[0] >= 0 && said[0] != character.loa)
    warn_once(file.warnings, "the file says loa " + std::to_string(said[0]) +
                                 ", its joints are those of loa " + std::to_string(character.loa));
  for (const char* field : {"jointBindingPositions", "jointBindingRotations", "jointBindingScales"})
    if (find_field(node, field)) warn_once(file.warnings, std::string(field) + " is not used");
  note_left_out(file);
  if (character.parts.empty()) warn_once(file.warnings, "the figure has no surface");
  character.warnings = file.warnings;
  check_figure(character);
  return std::move(reader.character);
}

}  // namespace wellspring::avatar
