// SPDX-License-Identifier: Apache-2.0
// Whole expressions of a VRM file: sums of morph targets as displacers, what they change of
// materials, and what they forbid.
#include <cmath>
#include <unordered_set>

#include "avatar/load/gltf_figure.h"

namespace wellspring::avatar {
namespace {

using gltf::items;
using gltf::json;

struct MorphReader {
  GltfFigure& figure;
  Character& character = figure.character;
  size_t moved = 0;
  std::vector<Displacer> made;  // of the expressions
  std::unordered_set<std::string> names;

  void add_moves(const VrmExpression& expression, Displacer& displacer);
  void add_changes(const VrmExpression& expression, int displacer);
  void add(const VrmExpression& expression);
};

// Nodes that a bind means: its own, or all that hold its mesh.
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
    // What it changes from: how the picture of the base colour lies (KHR_texture_transform).
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
  // Expressions come first: of an expression and a morph target with one name, the expression
  // counts.
  std::vector<Displacer>& all = figure.character.displacers;
  for (Displacer& target : all)
    if (!reader.names.count(target.name)) reader.made.push_back(std::move(target));
  all = std::move(reader.made);
}

}  // namespace wellspring::avatar
