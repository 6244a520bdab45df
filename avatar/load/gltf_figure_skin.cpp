// SPDX-License-Identifier: Apache-2.0
// Reads meshes of a glTF file at rest in humanoid space, with their weights, looks and morph
// targets.
#include <algorithm>
#include <cmath>

#include "avatar/load/gltf_figure.h"
#include "gltf/data.h"
#include "gltf/primitive.h"

namespace wellspring::avatar {
namespace {

using nlohmann::json;

using gltf::at;
using gltf::items;
using gltf::json;
using gltf::Used;

constexpr size_t vertex_limit = 3'000'000;
constexpr float farthest = 1e15f;

struct SkinReader {
  GltfFigure& figure;
  Character& character = figure.character;
  gltf::File& file = figure.file;
  size_t displacements = 0;
  bool second_uv = false, colors = false;

  void read_appearances();
  void read_node(size_t node);
  void read_primitive(size_t node, size_t mesh, size_t index, const dmat4& copy);
  // Returns each vertex's matrix from its mesh to humanoid space at rest; appends the weights.
  std::vector<dmat4> read_weights(size_t node, const json& primitive, const std::string& where,
                                  const Used& used, const dmat4& copy);
  void read_targets(size_t node, const json& mesh, size_t mesh_index, const json& primitive,
                    const Used& used, const std::vector<dmat4>& to_rest, uint32_t first,
                    const std::vector<double>& weights);
};

void SkinReader::read_appearances() {
  const json& materials = items(file.root, "materials");
  for (size_t m = 0; m <= materials.size(); m++) {
    Appearance appearance;
    appearance.material = int(m);  // 0 is the default material, as in world/load/gltf_material.h
    if (m == 0) {
      appearance.name = "default";
    } else {
      const json& material = materials[m - 1];
      appearance.name = gltf::text(material, "name");
      appearance.double_sided = gltf::boolean(material, "doubleSided", false);
      appearance.lambertian = figure.vrm.lambertian.count(m - 1) > 0;
      if (const json* pbr = gltf::find(material, "pbrMetallicRoughness")) {
        if (const json* color = gltf::find(*pbr, "baseColorFactor")) {
          for (int c = 0; c < 3; c++)
            appearance.base_color[c] = gltf::to_float((*color)[size_t(c)].get<double>());
          appearance.alpha = gltf::to_float((*color)[3].get<double>());
        }
        appearance.metallic = gltf::to_float(gltf::number(*pbr, "metallicFactor", 1));
        appearance.roughness = gltf::to_float(gltf::number(*pbr, "roughnessFactor", 1));
      }
      if (appearance.lambertian)
        gltf::warn(file, at("/materials", m - 1),
                   "materials drawn as cartoons (MToon, unlit) are shown matt, lit as all else is");
    }
    character.appearances.push_back(appearance);
  }
}

std::vector<dmat4> SkinReader::read_weights(size_t node, const json& primitive,
                                            const std::string& where, const Used& used,
                                            const dmat4& copy) {
  const json& attributes = primitive["attributes"];
  const json* skin = gltf::find(items(file.root, "nodes")[node], "skin");
  std::vector<dmat4> to_rest(used.size(), dmat4(0));
  if (!skin || !gltf::find(attributes, "JOINTS_0")) {
    if (skin) gltf::warn(file, at("/nodes", node), "a skin on a mesh without joints is ignored");
    int joint = figure.nearest_joint[node];
    if (joint < 0) gltf::warn(file, at("/nodes", node), "what hangs on no joint follows the root");
    joint = std::max(joint, 0);
    for (dmat4& m : to_rest) {
      m = figure.to_humanoid * figure.rest[node] * copy;
      character.weights.push_back({uint16_t(joint), 1});
      character.first_weight.push_back(uint32_t(character.weights.size()));
    }
    return to_rest;
  }
  const json& object = items(file.root, "skins")[skin->get<size_t>()];
  const json& joints = object["joints"];
  std::vector<dmat4> matrices;
  std::shared_ptr<const std::vector<float>> binds;
  if (const json* accessor = gltf::find(object, "inverseBindMatrices"))
    binds = gltf::read_floats(file, accessor->get<size_t>());
  for (size_t j = 0; j < joints.size(); j++) {
    dmat4 bind(1);
    for (size_t i = 0; binds && i < 16; i++)
      if (i % 4 < 3) bind[int(i / 4)][int(i % 4)] = double((*binds)[j * 16 + i]);
    matrices.push_back(figure.to_humanoid * figure.rest[joints[j].get<size_t>()] * bind);
  }
  struct Set {
    std::vector<uint32_t> joint;
    std::vector<float> weight;
  };
  std::vector<Set> sets;
  for (int set = 0;; set++) {
    const json* accessor = gltf::find(attributes, gltf::numbered("JOINTS_", set).c_str());
    if (!accessor) break;
    sets.push_back({gltf::read_integers(file, accessor->get<size_t>()),
                    gltf::read_attribute(file, attributes, gltf::numbered("WEIGHTS_", set), used)});
  }
  size_t without = 0;
  for (size_t v = 0; v < used.size(); v++) {
    size_t begin = character.weights.size();
    double sum = 0;
    for (const Set& set : sets)
      for (size_t c = 0; c < 4; c++) {
        float weight = set.weight[v * 4 + c];
        uint32_t joint = set.joint[used[v] * size_t(4) + c];
        if (!std::isfinite(weight))
          gltf::refuse(file, where,
                       "vertex " + std::to_string(used[v]) + " has a weight that is not finite");
        if (weight < 0) gltf::warn(file, where, "negative weights are left out");
        if (!(weight > 0)) continue;
        if (joint >= matrices.size())
          gltf::refuse(file, where,
                       "vertex " + std::to_string(used[v]) + " hangs on joint " +
                           std::to_string(joint) + " of " + std::to_string(matrices.size()));
        uint16_t own = uint16_t(figure.joint_of[joints[joint].get<size_t>()]);
        to_rest[v] += matrices[joint] * double(weight);
        sum += double(weight);
        auto same =
            std::find_if(character.weights.begin() + std::ptrdiff_t(begin), character.weights.end(),
                         [&](const JointWeight& w) { return w.joint == own; });
        if (same != character.weights.end()) same->weight += weight;
        else character.weights.push_back({own, weight});
      }
    if (sum > 0) {
      to_rest[v] *= 1 / sum;
      for (size_t k = begin; k < character.weights.size(); k++)
        character.weights[k].weight = float(double(character.weights[k].weight) / sum);
    } else {
      without++;
      to_rest[v] = matrices.empty() ? figure.to_humanoid : matrices[0];
      character.weights.push_back({uint16_t(figure.joint_of[joints[0].get<size_t>()]), 1});
    }
    character.first_weight.push_back(uint32_t(character.weights.size()));
  }
  if (without)
    gltf::warn(file, where,
               std::to_string(without) + " vertices have no weight: they follow the first joint");
  return to_rest;
}

// Returns a target's name: extras.targetNames is what everybody writes.
std::string target_name(const json& mesh, const json& primitive, size_t target) {
  for (const json* holder : {&primitive, &mesh})
    if (const json* extras = gltf::find(*holder, "extras"))
      if (extras->is_object())
        if (const json* names = gltf::find(*extras, "targetNames"))
          if (names->is_array() && target < names->size() && (*names)[target].is_string())
            return (*names)[target].get<std::string>().substr(0, 200);
  return gltf::text(mesh, "name", "morph").substr(0, 100) + " " + std::to_string(target);
}

void SkinReader::read_targets(size_t node, const json& mesh, size_t mesh_index,
                              const json& primitive, const Used& used,
                              const std::vector<dmat4>& to_rest, uint32_t first,
                              const std::vector<double>& weights) {
  const json& targets = items(primitive, "targets");
  for (size_t t = 0; t < targets.size(); t++) {
    std::vector<vec3> moves = gltf::read_vec3s(file, targets[t], "POSITION", used);
    Displacer& move = figure.moves[{node, t}];
    move.name = target_name(mesh, primitive, t);
    for (size_t v = 0; v < moves.size(); v++) {
      vec3 turned(glm::dmat3(to_rest[v]) * dvec3(moves[v]));
      if (!is_finite(turned) || !(glm::length(turned) > 1e-7f)) continue;
      if (++displacements > most_displacements)
        gltf::refuse(file, at("/meshes", mesh_index), "morph targets move too many vertices");
      // A figure whose morph has a weight at rest rests with it.
      double at_rest = t < weights.size() ? weights[t] : 0;
      if (at_rest != 0) character.positions[first + v] += turned * float(at_rest);
      move.vertices.push_back(first + uint32_t(v));
      move.displacements.push_back(turned);
    }
  }
}

void SkinReader::read_primitive(size_t node, size_t mesh_index, size_t index, const dmat4& copy) {
  const json& mesh = items(file.root, "meshes")[mesh_index];
  const json& primitive = mesh["primitives"][index];
  const json& attributes = primitive["attributes"];
  const std::string where = at(at("/meshes", mesh_index) + "/primitives", index);
  gltf::check_primitive(file, primitive, where);
  const json* accessor = gltf::find(attributes, "POSITION");
  if (!accessor) return;
  size_t count = size_t(gltf::form_of(file, accessor->get<size_t>()).count);
  gltf::Corners corners = gltf::read_corners(file, primitive, where, count);
  if (corners.triangles.empty()) return;
  bool flat = !gltf::find(attributes, "NORMAL");
  if (flat) {  // faces that share no corner
    Used alone;
    for (uvec3& t : corners.triangles)
      for (int c = 0; c < 3; c++) {
        alone.push_back(corners.used[t[c]]);
        t[c] = uint32_t(alone.size() - 1);
      }
    corners.used = std::move(alone);
  }
  const Used& used = corners.used;
  uint32_t first = uint32_t(character.positions.size());
  if (first + used.size() > vertex_limit)
    gltf::refuse(file, where, "more than " + std::to_string(vertex_limit) + " vertices");
  std::vector<vec3> positions = gltf::read_vec3s(file, attributes, "POSITION", used);
  std::vector<vec3> normals = gltf::read_vec3s(file, attributes, "NORMAL", used);
  std::vector<vec2> uv = gltf::read_vec2s(file, attributes, "TEXCOORD_0", used);
  std::vector<vec2> second = gltf::read_vec2s(file, attributes, "TEXCOORD_1", used);
  int64_t material = gltf::integer(primitive, "material", -1);
  bool mtoon = material >= 0 && gltf::extension(items(file.root, "materials")[size_t(material)],
                                                "VRMC_materials_mtoon");
  std::vector<vec4> color;  // MToon ignores it
  if (!mtoon) color = gltf::read_vec4s(file, attributes, "COLOR_0", used);
  std::vector<dmat4> to_rest = read_weights(node, primitive, where, used, copy);
  const bool mirrored = gltf::is_mirrored(figure.nodes[node].global * copy);
  std::vector<char> bad(used.size(), 0);
  for (size_t v = 0; v < used.size(); v++) {
    vec3 p(to_rest[v] * dvec4(positions[v], 1));
    bad[v] = !(std::abs(p.x) < farthest && std::abs(p.y) < farthest && std::abs(p.z) < farthest);
    character.positions.push_back(bad[v] ? vec3(0) : p);
    glm::dmat3 m(to_rest[v]);
    double turn = glm::determinant(m);
    vec3 n(0, 0, 1);
    if (!flat) {
      dvec3 given(normals[v]);
      dvec3 bent = glm::cross(m[1], m[2]) * given.x + glm::cross(m[2], m[0]) * given.y +
                   glm::cross(m[0], m[1]) * given.z;
      double length = glm::length(bent);
      if (length > 1e-30 && std::isfinite(length)) n = vec3(bent / (turn < 0 ? -length : length));
      else gltf::warn(file, where, "normals without a direction are replaced");
    }
    character.normals.push_back(n);
    auto finite = [](vec2 p2) { return std::isfinite(p2.x) && std::isfinite(p2.y) ? p2 : vec2(0); };
    character.uv.push_back(uv.empty() ? vec2(0) : finite(uv[v]));
    character.second_uv.push_back(second.empty() ? vec2(0) : finite(second[v]));
    vec4 c(1);
    for (int k = 0; !color.empty() && k < 4; k++)
      if (std::isfinite(color[v][k])) c[k] = glm::clamp(color[v][k], 0.0f, 1e6f);
    character.colors.push_back(c);
  }
  second_uv = second_uv || !second.empty();
  colors = colors || !color.empty();
  read_targets(node, mesh, mesh_index, primitive, used, to_rest, first, figure.nodes[node].weights);

  Part part;
  part.name = gltf::text(items(file.root, "nodes")[node], "name", gltf::text(mesh, "name"));
  part.appearance = int(material) + 1;
  size_t dropped = 0;
  for (uvec3 t : corners.triangles) {
    if (bad[t.x] || bad[t.y] || bad[t.z]) {
      dropped++;
      continue;
    }
    if (mirrored) std::swap(t.y, t.z);
    t += first;
    if (flat) {
      vec3 face = cross(character.positions[t.y] - character.positions[t.x],
                        character.positions[t.z] - character.positions[t.x]);
      float length = glm::length(face);
      for (int c = 0; length > 1e-30f && c < 3; c++) character.normals[t[c]] = face / length;
    }
    part.triangles.push_back(t);
  }
  if (dropped)
    gltf::warn(file, where,
               std::to_string(dropped) + " triangles with a corner at no finite place are dropped");
  if (!part.triangles.empty()) character.parts.push_back(std::move(part));
}

void SkinReader::read_node(size_t node) {
  const json* mesh = gltf::find(items(file.root, "nodes")[node], "mesh");
  if (!mesh) return;
  size_t index = mesh->get<size_t>();
  if (figure.vrm.hidden_nodes.count(node) || figure.vrm.hidden_meshes.count(index)) return;
  size_t count = items(file.root, "meshes")[index]["primitives"].size();
  std::vector<dmat4> copies = gltf::read_instances(file, node);
  if (gltf::find(items(file.root, "nodes")[node], "skin")) copies.assign(1, dmat4(1));
  for (const dmat4& copy : copies)
    for (size_t p = 0; p < count; p++) read_primitive(node, index, p, copy);
}

}  // namespace

void read_gltf_surfaces(GltfFigure& figure) {
  SkinReader reader{figure};
  reader.read_appearances();
  for (size_t i = 0; i < figure.nodes.size(); i++)
    if (figure.nodes[i].shown) reader.read_node(i);
  Character& character = figure.character;
  if (!reader.second_uv) character.second_uv.clear();
  if (!reader.colors) character.colors.clear();
  // Targets of one name move as one: the teeth open with the lips.
  std::map<std::string, size_t> place_of;
  for (const auto& [key, move] : figure.moves) {
    if (move.vertices.empty()) continue;
    auto [place, added] = place_of.emplace(move.name, character.displacers.size());
    if (added) character.displacers.push_back({move.name, {}, {}});
    Displacer& displacer = character.displacers[place->second];
    displacer.vertices.insert(displacer.vertices.end(), move.vertices.begin(), move.vertices.end());
    displacer.displacements.insert(displacer.displacements.end(), move.displacements.begin(),
                                   move.displacements.end());
  }
}

}  // namespace wellspring::avatar
