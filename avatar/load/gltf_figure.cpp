// SPDX-License-Identifier: Apache-2.0
#include "avatar/load/gltf_figure.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <unordered_set>

#include "avatar/figure/figure_check.h"
#include "avatar/figure/face_names.h"
#include "avatar/figure/joint_constraints.h"

namespace wellspring::avatar {
namespace {

using nlohmann::json;

// Notes cameras and lights: a figure brings none of its own.
void note_left_out(gltf::File& file) {
  auto note = [&](size_t count, const char* where, const char* what) {
    if (count > 0)
      gltf::warn(file, where, "left out, as a figure has none: " + std::to_string(count) + what);
  };
  note(gltf::items(file.root, "cameras").size(), "/cameras", " camera(s)");
  if (const auto* lights = gltf::extension(file.root, "KHR_lights_punctual"))
    note(gltf::items(*lights, "lights").size(), "/extensions/KHR_lights_punctual", " light(s)");
}

}  // namespace

Character character_from_gltf(const std::string& path) {
  GltfFigure figure;
  figure.file = gltf::load_gltf(path, "", vrm_extensions());
  figure.vrm = read_vrm(figure.file);
  figure.nodes = gltf::make_pose(figure.file, 0);
  Character& character = figure.character;
  character.first_weight = {0};
  character.material_file = path;
  character.eye_ranges = figure.vrm.eye_ranges;
  character.metadata = figure.vrm.metadata;
  for (const auto& [key, value] : character.metadata)
    if (key == "title" || (key == "name" && character.name.empty())) character.name = value;
  if (character.name.empty()) character.name = std::filesystem::path(path).stem().string();
  read_gltf_joints(figure);
  read_gltf_surfaces(figure);
  read_gltf_expressions(figure);
  read_gltf_constraints(figure);
  read_gltf_springs(figure);
  read_gltf_motions(figure);
  std::vector<std::string_view> names;
  for (const Joint& joint : character.joints) names.push_back(joint.name);
  character.loa = level_of_articulation(names);
  if (character.parts.empty())
    gltf::warn(figure.file, "",
               figure.vrm.animation ? "a motion without a figure" : "the figure has no surface");
  note_left_out(figure.file);
  for (std::string& warning : figure.file.warnings)
    character.warnings.push_back(std::move(warning));
  complete_face(character);
  check_figure(character);
  return std::move(character);
}

// Turns constraints between a file's nodes into constraints between the figure's joints: axes in
// humanoid space, in an order in which they can be followed.

void read_gltf_constraints(GltfFigure& figure) {
  Character& character = figure.character;
  glm::dquat to_humanoid = gltf_rotation(figure.to_humanoid);
  auto turn_of = [&](size_t node) { return to_humanoid * gltf_rotation(figure.rest[node]); };
  auto turn_above = [&](size_t node) {
    int parent = figure.nodes[node].parent;
    return parent < 0 ? to_humanoid : turn_of(size_t(parent));
  };
  for (const VrmConstraint& asked : figure.vrm.constraints) {
    JointConstraint constraint;
    constraint.joint = figure.joint_of[asked.node];
    constraint.source = figure.joint_of[asked.source];
    if (constraint.joint < 0 || constraint.source < 0) continue;
    constraint.kind = asked.kind;
    constraint.weight = asked.weight;
    constraint.axis = quat(turn_of(asked.node)) * asked.axis;
    // A rotation is carried from the source's own axes to the joint's own, a roll from the axes of
    // the source's parent to those of the joint's parent.
    if (asked.kind == JointConstraint::Kind::rotation)
      constraint.between =
          quat(glm::normalize(turn_of(asked.node) * glm::conjugate(turn_of(asked.source))));
    else if (asked.kind == JointConstraint::Kind::roll)
      constraint.between =
          quat(glm::normalize(turn_above(asked.node) * glm::conjugate(turn_above(asked.source))));
    character.constraints.push_back(constraint);
  }
  std::vector<JointConstraint> circular = sort_constraints(character.joints, character.constraints);
  if (circular.empty()) return;
  std::string names;
  for (size_t k = 0; k < circular.size() && k < 8; k++)
    names += (k ? ", " : "") + character.joints[size_t(circular[k].joint)].name.substr(0, 40);
  gltf::warn(
      figure.file, "/nodes",
      "constraints that depend on themselves or on one another in a circle are not followed: " +
          names + (circular.size() > 8 ? ", ..." : ""));
}

// Turns springs of a VRM file into springs of the figure: by joint, in humanoid space, metres.

void read_gltf_springs(GltfFigure& figure) {
  Character& character = figure.character;
  auto place = [&](size_t node, vec3 offset) {
    return vec3(figure.to_humanoid * figure.rest[node] * dvec4(dvec3(offset), 1));
  };
  auto size_at = [&](size_t node) {
    return float(
        std::cbrt(std::abs(glm::determinant(glm::dmat3(figure.to_humanoid * figure.rest[node])))));
  };
  std::vector<int> collider_of;  // the figure's collider for each of the file's
  for (const VrmCollider& collider : figure.vrm.colliders) {
    SpringCollider made;
    made.joint = figure.nearest_joint[collider.node];
    made.place = place(collider.node, collider.offset);
    made.tail = place(collider.node, collider.tail);
    made.radius = collider.radius * size_at(collider.node);
    made.inside = collider.inside;
    if (collider.normal != vec3(0)) {
      vec3 normal = place(collider.node, collider.offset + collider.normal) - made.place;
      float length = glm::length(normal);
      made.normal = length > 0 ? normal / length : vec3(0, 1, 0);
    }
    bool sound = made.joint >= 0 && is_finite(made.place) && is_finite(made.tail) &&
                 is_finite(made.normal) && std::isfinite(made.radius);
    collider_of.push_back(sound ? int(character.spring_colliders.size()) : -1);
    if (sound) character.spring_colliders.push_back(made);
  }
  // Gravity's directions are those of the file's world; its strength does not scale.
  glm::dmat3 turn(figure.to_humanoid);
  turn /= std::cbrt(std::abs(glm::determinant(turn)));
  for (const VrmSpringJoint& joint : figure.vrm.springs) {
    SpringBone bone;
    bone.joint = figure.joint_of[joint.node];
    if (bone.joint < 0) continue;  // nothing hangs on it
    vec3 own = character.joints[size_t(bone.joint)].center;
    bone.tail = (joint.tail_node >= 0 ? place(size_t(joint.tail_node), vec3(0))
                                      : place(joint.node, joint.tail)) -
                own;
    float length = glm::length(bone.tail);
    if (!(length > 1e-5f) || !std::isfinite(length)) continue;
    bone.stiffness = joint.stiffness;
    float direction = glm::length(joint.gravity_direction);
    if (direction > 1e-6f)
      bone.gravity = vec3(turn * dvec3(joint.gravity_direction / direction)) * joint.gravity_power;
    bone.drag = joint.drag;
    bone.radius = joint.hit_radius * size_at(joint.node);
    if (joint.center >= 0) bone.center = figure.nearest_joint[size_t(joint.center)];
    // not above the joint: it would turn with itself
    if (bone.center >= bone.joint) bone.center = -1;
    for (size_t c : joint.colliders)
      if (collider_of[c] >= 0) bone.colliders.push_back(collider_of[c]);
    character.springs.push_back(std::move(bone));
  }
  std::sort(character.springs.begin(), character.springs.end(),
            [](const SpringBone& a, const SpringBone& b) { return a.joint < b.joint; });
}

// Reads whole expressions of a VRM file: sums of morph targets as displacers, their changes of
// materials, and what they forbid.

namespace {

using gltf::items;
using gltf::json;

struct MorphReader {
  GltfFigure& figure;
  Character& character = figure.character;
  size_t moved = 0;
  std::vector<Displacer> made;  // displacers of the expressions
  std::unordered_set<std::string> names;

  void add_moves(const VrmExpression& expression, Displacer& displacer);
  void add_changes(const VrmExpression& expression, int displacer);
  void add(const VrmExpression& expression);
};

// Returns the nodes that a bind means: its own, or all that hold its mesh.
std::vector<size_t> nodes_of(const GltfFigure& figure, const VrmBind& bind) {
  std::vector<size_t> nodes;
  if (bind.node >= 0) return {size_t(bind.node)};
  const json& list = items(figure.file.root, "nodes");
  for (size_t n = 0; n < list.size(); n++)
    if (gltf::integer(list[n], "mesh", -1) == bind.mesh) nodes.push_back(n);
  return nodes;
}

void MorphReader::add_moves(const VrmExpression& expression, Displacer& displacer) {
  std::map<uint32_t, vec3> sum;
  for (const VrmBind& bind : expression.binds) {
    bool known = false;
    for (size_t node : nodes_of(figure, bind)) {
      known = known || gltf::integer(items(figure.file.root, "nodes")[node], "mesh", -1) < 0;
      auto move = figure.moves.find({node, bind.target});
      if (move == figure.moves.end()) continue;
      known = true;
      if ((moved += move->second.vertices.size() + 1) > most_displacements)
        gltf::refuse(figure.file, "", "expressions move too many vertices");
      for (size_t i = 0; i < move->second.vertices.size(); i++)
        sum[move->second.vertices[i]] += move->second.displacements[i] * bind.weight;
    }
    if (!known)
      gltf::warn(figure.file, "",
                 "expression '" + expression.name.substr(0, 60) + "' names no morph target");
  }
  for (const auto& [vertex, move] : sum) {
    displacer.vertices.push_back(vertex);
    displacer.displacements.push_back(move);
  }
}

vec2 pair_of(const json& object, const char* key, float otherwise) {
  vec2 v(otherwise);
  if (const json* list = gltf::find(object, key))
    for (int c = 0; c < 2; c++) v[c] = gltf::to_float((*list)[size_t(c)].get<double>());
  return v;
}

void MorphReader::add_changes(const VrmExpression& expression, int displacer) {
  const json& materials = items(figure.file.root, "materials");
  std::map<size_t, AppearanceChange> changes;  // by material
  for (const VrmColorBind& bind : expression.colors) {
    const json& material = materials[bind.material];
    AppearanceChange& change = changes[bind.material];
    if (!bind.emission) {
      const Appearance& appearance = character.appearances[bind.material + 1];
      change.base_color += bind.target - vec4(appearance.base_color, appearance.alpha);
      continue;
    }
    vec3 factor(0);
    if (const json* list = gltf::find(material, "emissiveFactor"))
      for (int c = 0; c < 3; c++) factor[c] = gltf::to_float((*list)[size_t(c)].get<double>());
    const json* strong = gltf::extension(material, "KHR_materials_emissive_strength");
    float strength = strong ? gltf::to_float(gltf::number(*strong, "emissiveStrength", 1)) : 1;
    change.emission += (vec3(bind.target) - factor) * strength;
  }
  for (const VrmPictureBind& bind : expression.pictures) {
    // Changes start from the place of the base colour's picture (KHR_texture_transform).
    const json* pbr = gltf::find(materials[bind.material], "pbrMetallicRoughness");
    const json* picture = pbr ? gltf::find(*pbr, "baseColorTexture") : nullptr;
    const json* lies = picture ? gltf::extension(*picture, "KHR_texture_transform") : nullptr;
    vec2 scale(1), offset(0);
    float angle = 0;
    if (lies) {
      scale = pair_of(*lies, "scale", 1), offset = pair_of(*lies, "offset", 0);
      angle = gltf::to_float(gltf::number(*lies, "rotation", 0));
    }
    mat3& uv = changes[bind.material].uv;
    float c = std::cos(angle), s = std::sin(angle);
    const vec3 column[2] = {vec3(c, -s, 0), vec3(s, c, 0)};
    for (int axis = 0; axis < 2; axis++) {
      if (!bind.axis[size_t(axis)]) continue;
      uv[axis] += column[axis] * (bind.scale[axis] - scale[axis]);
      uv[2][axis] += bind.offset[axis] - offset[axis];
    }
  }
  for (auto& [material, change] : changes) {
    change.displacer = displacer;
    change.appearance = int(material) + 1;  // 0 is the default material
    character.appearance_changes.push_back(change);
  }
}

void MorphReader::add(const VrmExpression& expression) {
  Displacer displacer{expression.name.substr(0, 200), {}, {}};
  add_moves(expression, displacer);
  bool shows =
      !displacer.vertices.empty() || !expression.colors.empty() || !expression.pictures.empty();
  if (!shows || displacer.name.empty()) return;
  if (!names.insert(displacer.name).second)
    return gltf::warn(
        figure.file, "",
        "expression '" + displacer.name.substr(0, 60) + "' is there twice: the first counts");
  int index = int(made.size());
  made.push_back(std::move(displacer));
  add_changes(expression, index);
  bool forbids = expression.overrides != decltype(expression.overrides){};
  if (expression.binary || forbids)
    character.expression_rules.push_back({index, expression.binary, -1, expression.overrides});
}

}  // namespace

void read_gltf_expressions(GltfFigure& figure) {
  MorphReader reader{figure};
  for (const VrmExpression& expression : figure.vrm.expressions) reader.add(expression);
  if (reader.made.empty()) return;
  // Expressions come first: if an expression and a morph target have one name, the expression
  // counts.
  std::vector<Displacer>& all = figure.character.displacers;
  for (Displacer& target : all)
    if (!reader.names.count(target.name)) reader.made.push_back(std::move(target));
  all = std::move(reader.made);
}

}  // namespace wellspring::avatar
