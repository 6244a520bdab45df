// SPDX-License-Identifier: Apache-2.0
// Reads springs of VRM files: "secondaryAnimation" of version 0, "VRMC_springBone" of version 1.
#include <algorithm>
#include <set>

#include "avatar/load/vrm_extension.h"
#include "avatar/load/vrm_json.h"

namespace wellspring::avatar {

using nlohmann::json;

// Reads VRMC_node_constraint-1.0, which nodes of any glTF file may carry.

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

namespace {

using namespace vrm_json;

constexpr size_t collider_limit = 1000, spring_limit = 4096, meeting_limit = 100'000;
constexpr float leaf_length = 0.07f;  // length of the last bone of a row in version 0, metres

struct SpringReader {
  File& file;
  Vrm& vrm;
  std::set<size_t> taken;
  size_t meetings = 0;  // pairs of joints and colliders

  // Adds a spring; false when there is no room, or the node swings already or is a bone of the
  // body.
  bool add(VrmSpringJoint joint, const std::string& where) {
    if (vrm.joints.count(joint.node)) {
      gltf::warn(file, where, "a bone of the body does not swing");
      return false;
    }
    if (!taken.insert(joint.node).second) {
      gltf::warn(file, where, "a node swings by one spring only");
      return false;
    }
    if (vrm.springs.size() >= spring_limit) {
      gltf::warn(file, where,
                 "springs beyond the first " + std::to_string(spring_limit) + " do not swing");
      return false;
    }
    if (meetings + joint.colliders.size() > meeting_limit) {
      gltf::warn(file, where, "too many colliders: springs pass through those of the rest");
      joint.colliders.clear();
    }
    meetings += joint.colliders.size();
    joint.stiffness = std::clamp(joint.stiffness, 0.0f, 100.0f);
    joint.gravity_power = std::clamp(joint.gravity_power, -100.0f, 100.0f);
    joint.drag = std::clamp(joint.drag, 0.0f, 1.0f);
    joint.hit_radius = std::clamp(joint.hit_radius, 0.0f, 100.0f);
    vrm.springs.push_back(std::move(joint));
    return true;
  }

  void add_collider(VrmCollider collider) {
    collider.radius = std::clamp(collider.radius, 0.0f, 1000.0f);
    if (vrm.colliders.size() == collider_limit)
      gltf::warn(file, "",
                 "colliders beyond the first " + std::to_string(collider_limit) + " are left out");
    if (vrm.colliders.size() < collider_limit) vrm.colliders.push_back(collider);
  }

  // Reads indices of a list, each below `count`.
  std::vector<size_t> indices(const json& list, size_t count, const char* what,
                              const std::string& where) {
    std::vector<size_t> found;
    for (size_t i = 0; i < list.size(); i++) {
      int64_t index = list[i].is_number_integer() ? list[i].get<int64_t>() : -1;
      if (index < 0 || size_t(index) >= count)
        gltf::refuse(file, at(where, i),
                     "is none of the file's " + std::to_string(count) + " " + what);
      found.push_back(size_t(index));
    }
    return found;
  }

  void read_version_0();
  void read_version_1(const json& object);
  void read_shape(size_t node, const json& shape, bool extended, const std::string& where);
};

// Reads version 0, which writes collider offsets with z the other way round than glTF (UniVRM's
// left-handed space).
void SpringReader::read_version_0() {
  const std::string root = "/extensions/VRM/secondaryAnimation";
  const json& object =
      object_in(file, *gltf::extension(file.root, "VRM"), "secondaryAnimation", "/extensions/VRM");
  const json& nodes = gltf::items(file.root, "nodes");
  const json& groups = list_in(file, object, "colliderGroups", root);
  std::vector<std::pair<size_t, size_t>> range;  // range of each group's colliders
  for (size_t g = 0; g < groups.size(); g++) {
    std::string where = at(root + "/colliderGroups", g);
    size_t first = vrm.colliders.size();
    int node = index_in(file, groups[g], "node", "nodes", where);
    const json& list = list_in(file, groups[g], "colliders", where);
    for (size_t c = 0; node >= 0 && c < list.size(); c++) {
      VrmCollider collider;
      collider.node = size_t(node);
      collider.offset = vector_in(list[c], "offset", vec3(0)) * vec3(1, 1, -1);
      collider.tail = collider.offset;
      collider.radius = number_in(list[c], "radius", 0);
      add_collider(collider);
    }
    range.push_back({first, vrm.colliders.size()});
  }
  const json& bones = list_in(file, object, "boneGroups", root);
  for (size_t b = 0; b < bones.size(); b++) {
    std::string where = at(root + "/boneGroups", b);
    VrmSpringJoint like;
    like.stiffness = number_in(bones[b], "stiffiness", 1);  // the format's own spelling
    like.gravity_power = number_in(bones[b], "gravityPower", 0);
    like.gravity_direction = vector_in(bones[b], "gravityDir", vec3(0, -1, 0));
    like.drag = number_in(bones[b], "dragForce", 0.5f);
    like.hit_radius = number_in(bones[b], "hitRadius", 0);
    like.center = index_in(file, bones[b], "center", "nodes", where);
    for (size_t group : indices(list_in(file, bones[b], "colliderGroups", where), groups.size(),
                                "collider groups", where + "/colliderGroups"))
      for (size_t c = range[group].first; c < range[group].second; c++) like.colliders.push_back(c);
    // All nodes below the named ones swing, too.
    std::vector<size_t> open =
        indices(list_in(file, bones[b], "bones", where), nodes.size(), "nodes", where + "/bones");
    std::set<size_t> seen;
    while (!open.empty()) {
      size_t node = open.back();
      open.pop_back();
      if (!seen.insert(node).second) continue;
      VrmSpringJoint joint = like;
      joint.node = node;
      const json& children = gltf::items(nodes[node], "children");
      if (!children.empty()) {
        joint.tail_node = children[0].get<int>();
      } else {
        vec3 way = vec3(0, 1, 0);
        const json* translation = gltf::find(nodes[node], "translation");
        for (int c = 0; translation && c < 3; c++)
          way[c] = gltf::to_float((*translation)[size_t(c)].get<double>());
        float length = glm::length(way);
        joint.tail =
            (length > 1e-9f && std::isfinite(length) ? way / length : vec3(0, 1, 0)) * leaf_length;
      }
      add(std::move(joint), where);
      for (const json& child : children) open.push_back(child.get<size_t>());
    }
  }
}

void SpringReader::read_shape(size_t node, const json& shape, bool extended,
                              const std::string& where) {
  VrmCollider collider;
  collider.node = node;
  for (const char* kind : {"sphere", "capsule", "plane"}) {
    const json* found = shape.is_object() ? gltf::find(shape, kind) : nullptr;
    if (!found || (kind[0] == 'p' && !extended)) continue;
    collider.offset = vector_in(*found, "offset", vec3(0));
    collider.tail = kind[0] == 'c' ? vector_in(*found, "tail", vec3(0)) : collider.offset;
    collider.radius = number_in(*found, "radius", 0);
    if (kind[0] == 'p') collider.normal = vector_in(*found, "normal", vec3(0, 0, 1));
    if (const json* inside = found->is_object() ? gltf::find(*found, "inside") : nullptr)
      collider.inside = inside->is_boolean() && inside->get<bool>();
    return add_collider(collider);
  }
  gltf::warn(file, where, "collider of an unknown shape");
  add_collider(collider);  // a point, so that indices stay
}

void SpringReader::read_version_1(const json& object) {
  const std::string root = "/extensions/VRMC_springBone";
  const json& colliders = list_in(file, object, "colliders", root);
  for (size_t c = 0; c < colliders.size(); c++) {
    std::string where = at(root + "/colliders", c);
    int node = index_in(file, colliders[c], "node", "nodes", where);
    if (node < 0) gltf::refuse(file, where, "has no node");
    const json* better = gltf::extension(colliders[c], "VRMC_springBone_extended_collider");
    read_shape(size_t(node), object_in(file, better ? *better : colliders[c], "shape", where),
               better != nullptr, where);
  }
  const json& groups = list_in(file, object, "colliderGroups", root);
  std::vector<std::vector<size_t>> members;
  for (size_t g = 0; g < groups.size(); g++) {
    std::string where = at(root + "/colliderGroups", g);
    members.push_back(indices(list_in(file, groups[g], "colliders", where), colliders.size(),
                              "colliders", where));
  }
  const json& springs = list_in(file, object, "springs", root);
  for (size_t s = 0; s < springs.size(); s++) {
    std::string where = at(root + "/springs", s);
    int center = index_in(file, springs[s], "center", "nodes", where);
    std::vector<size_t> meets;
    for (size_t g : indices(list_in(file, springs[s], "colliderGroups", where), groups.size(),
                            "collider groups", where + "/colliderGroups"))
      for (size_t c : members[g])
        if (c < vrm.colliders.size() && meets.size() < meeting_limit) meets.push_back(c);
    const json& joints = list_in(file, springs[s], "joints", where);
    for (size_t j = 0; j < joints.size(); j++) {
      std::string place = at(where + "/joints", j);
      int node = index_in(file, joints[j], "node", "nodes", place);
      if (node < 0) gltf::refuse(file, place, "has no node");
      if (j + 1 == joints.size()) break;  // the last joint is only the end of the one before
      VrmSpringJoint joint;
      joint.node = size_t(node);
      joint.tail_node =
          index_in(file, joints[j + 1], "node", "nodes", at(where + "/joints", j + 1));
      joint.stiffness = number_in(joints[j], "stiffness", 1);
      joint.gravity_power = number_in(joints[j], "gravityPower", 0);
      joint.gravity_direction = vector_in(joints[j], "gravityDir", vec3(0, -1, 0));
      joint.drag = number_in(joints[j], "dragForce", 0.5f);
      joint.hit_radius = number_in(joints[j], "hitRadius", 0);
      joint.center = center;
      joint.colliders = meets;
      add(std::move(joint), place);
    }
  }
}

}  // namespace

void read_vrm_springs(File& file, Vrm& vrm) {
  SpringReader reader{file, vrm, {}};
  const json* springs = gltf::extension(file.root, "VRMC_springBone");
  if (springs) reader.read_version_1(*springs);
  else if (vrm.version == 0) reader.read_version_0();
}

}  // namespace wellspring::avatar
