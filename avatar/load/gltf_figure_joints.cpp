// SPDX-License-Identifier: Apache-2.0
// Turns nodes of a glTF file into joints: chooses them, names them, and puts them at rest.
#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "avatar/figure/bone_names.h"
#include "avatar/load/gltf_figure.h"
#include "gltf/data.h"

namespace wellspring::avatar {
namespace {

using nlohmann::json;

using gltf::at;
using gltf::items;
using gltf::json;

constexpr size_t joint_limit = 4096;

// Returns the inverse bind matrices of a skin; identities if it has none.
std::vector<dmat4> read_binds(GltfFigure& figure, size_t skin) {
  const json& object = items(figure.file.root, "skins")[skin];
  std::vector<dmat4> binds(object["joints"].size(), dmat4(1));
  const json* accessor = gltf::find(object, "inverseBindMatrices");
  if (!accessor) return binds;
  const std::string where = at("/skins", skin) + "/inverseBindMatrices";
  gltf::Form form = gltf::form_of(figure.file, accessor->get<size_t>());
  if (form.components != 16 || form.component_type != gltf::float_component)
    gltf::refuse(figure.file, where, "must be MAT4 of FLOAT");
  if (form.count < int64_t(binds.size()))
    gltf::refuse(figure.file, where,
                 "has " + std::to_string(form.count) + " matrices for " +
                     std::to_string(binds.size()) + " joints");
  auto values = gltf::read_floats(figure.file, accessor->get<size_t>());
  for (size_t j = 0; j < binds.size(); j++) {
    for (size_t i = 0; i < 16; i++) {
      float value = (*values)[j * 16 + i];
      if (!std::isfinite(value))
        gltf::refuse(figure.file, where, "matrix " + std::to_string(j) + " is not finite");
      if (i % 4 < 3) binds[j][int(i / 4)][int(i % 4)] = double(value);
    }
    if (!(std::abs(glm::determinant(binds[j])) > 1e-30))
      gltf::refuse(figure.file, where, "matrix " + std::to_string(j) + " has no inverse");
  }
  return binds;
}

// Chooses nodes that bend the figure, parents first: joints of skins, bones of VRM, moving nodes
// above these, and all nodes between.
std::vector<size_t> choose_nodes(GltfFigure& figure) {
  const json& root = figure.file.root;
  std::vector<char> wanted(figure.nodes.size(), 0);
  for (const json& skin : items(root, "skins"))
    for (const json& joint : skin["joints"]) wanted[joint.get<size_t>()] = 1;
  for (const auto& [node, joint] : figure.vrm.joints) wanted[node] = 1;
  for (const VrmSpringJoint& spring : figure.vrm.springs)
    if (!figure.vrm.joints.empty()) wanted[spring.node] = 1;
  bool any = std::find(wanted.begin(), wanted.end(), 1) != wanted.end();
  std::vector<char> moving(figure.nodes.size(), 0);
  for (const json& animation : items(root, "animations"))
    for (const json& channel : items(animation, "channels"))
      if (const json* node = gltf::find(channel["target"], "node"))
        if (gltf::text(channel["target"], "path") != "weights") moving[node->get<size_t>()] = 1;
  if (!any && figure.nodes.size() <= 5 * joint_limit) {  // parts that hang on named nodes
    std::vector<size_t> all = gltf_parents_first(figure.nodes);
    std::vector<Bone> bones;
    std::vector<int> place_of(figure.nodes.size(), -1);
    for (size_t i : all) {
      place_of[i] = int(bones.size());
      int parent = figure.nodes[i].parent;
      bones.push_back({gltf::text(items(root, "nodes")[i], "name"),
                       parent < 0 ? -1 : place_of[size_t(parent)],
                       vec3(figure.nodes[i].global[3])});
    }
    BoneNames named = name_bones(bones);
    size_t known = 0;
    for (size_t k = 0; k < all.size(); k++)
      if (!named.joints[k].empty()) wanted[all[k]] = 1, known++;
    any = known >= 6 && !named.by_shape;
  }
  if (!any)
    gltf::refuse(figure.file, "", "no skin, no VRM humanoid and no bones by name: not a figure");
  for (const VrmConstraint& constraint : figure.vrm.constraints)
    wanted[constraint.node] = wanted[constraint.source] = 1;
  // All nodes between two wanted nodes, or between a moving node and a wanted one, are joints.
  std::vector<size_t> order = gltf_parents_first(figure.nodes);
  std::vector<char> carries(wanted), hangs(wanted.size(), 0);  // a wanted node is below, above
  for (size_t k = order.size(); k-- > 0;)
    if (int parent = figure.nodes[order[k]].parent; parent >= 0 && carries[order[k]])
      carries[size_t(parent)] = 1;
  for (size_t i : order) {
    int parent = figure.nodes[i].parent;
    hangs[i] = parent >= 0 && (hangs[size_t(parent)] || wanted[size_t(parent)] ||
                               (moving[size_t(parent)] && carries[size_t(parent)]));
    if (carries[i] && (hangs[i] || moving[i])) wanted[i] = 1;
  }
  std::vector<size_t> chosen;
  for (size_t i : order)
    if (wanted[i]) chosen.push_back(i);
  if (chosen.size() > joint_limit)
    gltf::refuse(figure.file, "/skins", "more than " + std::to_string(joint_limit) + " joints");
  return chosen;
}

struct SkinBind {
  std::vector<size_t> nodes;
  std::vector<dmat4> binds;
};

// Returns whether the nodes stand elsewhere than the skin was bound.
bool is_posed(const GltfFigure& figure, const SkinBind& skin) {
  if (skin.nodes.empty()) return false;
  dmat4 first = figure.nodes[skin.nodes[0]].global * skin.binds[0];
  double size = 0, off = 0;
  for (size_t j = 0; j < skin.nodes.size(); j++) {
    dmat4 own = figure.nodes[skin.nodes[j]].global * skin.binds[j];
    dmat4 bound = glm::inverse(skin.binds[j]);
    for (int c = 0; c < 4; c++) {  // probes: the joint's place and a step along each of its axes
      dvec3 probe = dvec3(bound[3]) + (c < 3 ? 0.1 * dvec3(bound[c]) : dvec3(0));
      off = std::max(off, glm::length(dvec3((own - first) * dvec4(probe, 1))));
    }
    size = std::max(size, glm::length(dvec3(figure.nodes[skin.nodes[j]].global[3] -
                                            figure.nodes[skin.nodes[0]].global[3])));
  }
  return off > 0.005 * std::max(size, 1e-9);
}

// Puts every joint of the largest skin where it was bound, the rest along with them.
void rest_in_bind_pose(GltfFigure& figure, const SkinBind& skin) {
  dmat4 reference = figure.nodes[skin.nodes[0]].global * skin.binds[0];
  dvec3 place(figure.nodes[skin.nodes[0]].global[3]);
  for (size_t j = 0; j < skin.nodes.size(); j++)  // the topmost joint says where bind space lies
    if (figure.joint_of[skin.nodes[j]] < figure.joint_of[skin.nodes[0]]) {
      reference = figure.nodes[skin.nodes[j]].global * skin.binds[j];
      place = dvec3(figure.nodes[skin.nodes[j]].global[3]);
    }
  glm::dquat turn = gltf_rotation(reference), square = nearest_right_turn(turn);
  // The topmost joint, too, may be posed a little; bind spaces are square to the world.
  if (std::abs(glm::dot(turn, square)) > std::cos(0.5 * 0.5)) turn = square;
  double scale = std::cbrt(std::abs(glm::determinant(glm::dmat3(reference))));
  dmat4 to_world = glm::scale(glm::mat4_cast(turn), dvec3(scale));
  dvec3 bound(glm::inverse(reference) * dvec4(place, 1));
  to_world[3] = dvec4(place - dvec3(to_world * dvec4(bound, 0)), 1);
  std::vector<int> bound_as(figure.nodes.size(), -1);
  for (size_t j = 0; j < skin.nodes.size(); j++) bound_as[skin.nodes[j]] = int(j);
  for (size_t i : gltf_parents_first(figure.nodes)) {
    int parent = figure.nodes[i].parent;
    figure.rest[i] = bound_as[i] >= 0 ? to_world * glm::inverse(skin.binds[size_t(bound_as[i])])
                                      : (parent < 0 ? dmat4(1) : figure.rest[size_t(parent)]) *
                                            figure.nodes[i].matrix;
  }
}

void name_joints(GltfFigure& figure, std::vector<Bone>& bones) {
  std::vector<std::string> names(bones.size());
  if (!figure.vrm.joints.empty()) {
    for (size_t j = 0; j < bones.size(); j++) {
      auto found = figure.vrm.joints.find(figure.node_of[j]);
      if (found != figure.vrm.joints.end()) names[j] = found->second;
    }
  } else {
    BoneNames named = name_bones(bones);
    names = std::move(named.joints);
    if (named.by_shape)
      gltf::warn(figure.file, "/nodes", "bones without telling names are joints by their place");
  }
  std::string unknown;
  size_t count = 0;
  std::unordered_set<std::string> taken(names.begin(), names.end());
  for (size_t j = 0; j < bones.size(); j++) {
    if (!names[j].empty()) continue;
    std::string own =
        bones[j].name.empty() ? "node " + std::to_string(figure.node_of[j]) : bones[j].name;
    if (++count <= 8) unknown += (count > 1 ? ", " : "") + own.substr(0, 40);
    while (!taken.insert(own).second) own += "_" + std::to_string(j);
    names[j] = own;
  }
  if (count)
    gltf::warn(figure.file, "/nodes",
               std::to_string(count) + (count == 1 ? " bone is" : " bones are") +
                   " no joint of H-Anim: " + unknown + (count > 8 ? ", ..." : ""));
  for (size_t j = 0; j < bones.size(); j++) figure.character.joints[j].name = names[j];
}

}  // namespace

std::vector<size_t> gltf_parents_first(const std::vector<gltf::Node>& nodes) {
  std::vector<std::vector<size_t>> children(nodes.size());
  std::vector<size_t> order, open;
  for (size_t i = nodes.size(); i-- > 0;) {
    if (nodes[i].parent < 0) open.push_back(i);
    else children[size_t(nodes[i].parent)].push_back(i);
  }
  while (!open.empty()) {
    size_t i = open.back();
    open.pop_back();
    order.push_back(i);
    open.insert(open.end(), children[i].begin(), children[i].end());
  }
  return order;
}

glm::dquat gltf_rotation(const dmat4& m) {
  dvec3 x(m[0]), y(m[1]), z(m[2]);
  auto safe = [](dvec3 v, dvec3 otherwise) {
    double length = glm::length(v);
    return length > 1e-12 ? v / length : otherwise;
  };
  x = safe(x, dvec3(1, 0, 0));
  y = safe(y - x * glm::dot(x, y), safe(glm::cross(z, x), dvec3(0, 1, 0)));
  return glm::quat_cast(glm::dmat3(x, y, glm::cross(x, y)));
}

glm::dquat nearest_right_turn(glm::dquat turn) {
  glm::dmat3 m = glm::mat3_cast(turn), square(0);
  int used = -1;
  for (int c = 0; c < 2; c++) {
    int best = -1;
    for (int r = 0; r < 3; r++)
      if (r != used && (best < 0 || std::abs(m[c][r]) > std::abs(m[c][best]))) best = r;
    square[c][best] = m[c][best] < 0 ? -1 : 1;
    used = best;
  }
  square[2] = glm::cross(square[0], square[1]);
  return glm::quat_cast(square);
}

void read_gltf_joints(GltfFigure& figure) {
  Character& character = figure.character;
  figure.node_of = choose_nodes(figure);
  figure.joint_of.assign(figure.nodes.size(), -1);
  for (size_t j = 0; j < figure.node_of.size(); j++) figure.joint_of[figure.node_of[j]] = int(j);
  for (const gltf::Node& node : figure.nodes) figure.rest.push_back(node.global);
  figure.nearest_joint = figure.joint_of;
  for (size_t i : gltf_parents_first(figure.nodes))
    if (int parent = figure.nodes[i].parent; figure.nearest_joint[i] < 0 && parent >= 0)
      figure.nearest_joint[i] = figure.nearest_joint[size_t(parent)];

  const json& skins = items(figure.file.root, "skins");
  SkinBind main;
  for (size_t s = 0; s < skins.size(); s++) {
    SkinBind skin{{}, read_binds(figure, s)};
    for (const json& joint : skins[s]["joints"]) skin.nodes.push_back(joint.get<size_t>());
    const json* extras = gltf::find(skins[s], "extras");
    if (extras && extras->is_object())
      if (const json* wish = gltf::find(*extras, "skinning"); wish && *wish == "dual_quaternion")
        character.skinning = Skinning::dual_quaternion;
    if (gltf::find(skins[s], "inverseBindMatrices") && skin.nodes.size() > main.nodes.size())
      main = std::move(skin);
  }
  bool posed = is_posed(figure, main);
  if (posed) {
    rest_in_bind_pose(figure, main);
    gltf::warn(figure.file, "/nodes",
               "the file poses the figure: rest is the pose its skin was bound in");
  }

  std::vector<Bone> bones;
  for (size_t node : figure.node_of) {
    int above = figure.nodes[node].parent;
    int parent = above < 0 ? -1 : figure.nearest_joint[size_t(above)];
    bones.push_back({gltf::text(items(figure.file.root, "nodes")[node], "name"), parent,
                     vec3(figure.rest[node][3])});
    character.joints.push_back({});
    character.joints.back().parent = parent;
  }
  name_joints(figure, bones);

  // The figure is put upright, facing +Z, in metres, over the middle of the floor.
  std::vector<std::string> names;
  std::vector<vec3> places;
  for (size_t j = 0; j < bones.size(); j++)
    names.push_back(character.joints[j].name), places.push_back(bones[j].place);
  quat turn = upright_turn(names, places);
  bool known_pair = find_joint(character, "l_hip") >= 0 || find_joint(character, "l_shoulder") >= 0;
  if (!known_pair && figure.vrm.version == 0) turn = quat(0, 0, 1, 0);
  if (std::abs(turn.w) < 0.999f && figure.vrm.version != 0)
    gltf::warn(figure.file, "/nodes", "the figure is turned to stand upright and face +Z");
  double size = 0;
  for (const Bone& bone : bones)
    size = std::max(size, double(glm::length(bone.place - bones[0].place)));
  double scale = 1;
  if (size > 40 && size < 400) {
    scale = 0.01;
    gltf::warn(figure.file, "/nodes",
               "the figure is as large as if its unit were the centimetre: taken so");
  }
  figure.to_humanoid = glm::scale(glm::mat4_cast(glm::dquat(turn)), dvec3(scale));
  int root = std::max(find_joint(character, "humanoid_root"), 0);
  dvec3 middle(figure.to_humanoid * figure.rest[figure.node_of[size_t(root)]][3]);
  if (std::abs(middle.x) > 0.5 || std::abs(middle.z) > 0.5)
    figure.to_humanoid[3] = dvec4(-middle.x, 0, -middle.z, 1);

  for (size_t j = 0; j < bones.size(); j++) {
    Joint& joint = character.joints[j];
    size_t node = figure.node_of[j];
    joint.center = vec3(figure.to_humanoid * figure.rest[node][3]);
    if (!is_finite(joint.center))
      gltf::refuse(figure.file, at("/nodes", node), "rests at no finite place");
    if (!posed) continue;
    auto moved = [&](size_t n) {
      glm::dquat h(turn);
      return h * gltf_rotation(figure.nodes[n].global) *
             glm::conjugate(gltf_rotation(figure.rest[n])) * glm::conjugate(h);
    };
    glm::dquat below =
        joint.parent < 0 ? glm::dquat(1, 0, 0, 0) : moved(figure.node_of[size_t(joint.parent)]);
    joint.rest_rotation = quat(glm::normalize(glm::conjugate(below) * moved(node)));
  }
}

}  // namespace wellspring::avatar
