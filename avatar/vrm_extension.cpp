// SPDX-License-Identifier: Apache-2.0
#include "avatar/vrm_extension.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "avatar/bone_names.h"
#include "avatar/vrm_json.h"

namespace wellspring {
namespace {

using namespace vrm_json;

void add_bone(File& file, Vrm& vrm, const std::string& bone, int node, const std::string& where) {
  if (node < 0) return;
  std::string joint = vrm_bone_joint(bone, vrm.version);
  if (joint.empty()) return gltf::warn(file, where, "unknown humanoid bone '" + bone.substr(0, 60) + "'");
  for (const auto& [other, name] : vrm.joints)
    if (name == joint) return gltf::warn(file, where, "bone '" + bone + "' is named twice");
  if (!vrm.joints.emplace(size_t(node), joint).second)
    gltf::warn(file, where, "one node is two bones");
}

void add_metadata(const File& file, const json& meta, const std::string& where, Vrm& vrm) {
  for (auto it = meta.begin(); it != meta.end(); ++it) {
    std::string value;
    if (it->is_string()) value = it->get<std::string>();
    else if (it->is_boolean()) value = it->get<bool>() ? "yes" : "no";
    else if (it->is_array())
      for (const json& one : *it)
        if (one.is_string()) value += (value.empty() ? "" : ", ") + one.get<std::string>();
    if (!value.empty() && it.key() != "texture" && vrm.metadata.size() < 100)
      vrm.metadata.push_back({it.key().substr(0, 100), value.substr(0, 1000)});
  }
}

// Degrees of eye for degrees of gaze.
float range_gain(const json& range, const char* input, const char* output) {
  float most = number_in(range, input, 90), scale = number_in(range, output, 10);
  return most > 0.1f ? std::clamp(scale / most, 0.0f, 1.0f) : 1.0f;
}

// Morph targets of an expression: `of` names what holds them, a mesh of the file or a node; weights are in
// parts of `full`.
void add_binds(const File& file, const json& binds, const char* of, const char* into, float full,
               const std::string& where, VrmExpression& expression) {
  for (size_t b = 0; b < binds.size(); b++) {
    int index = index_in(file, binds[b], of, into, at(where, b));
    if (index < 0) continue;
    VrmBind bind;
    (into == std::string_view("meshes") ? bind.mesh : bind.node) = index;
    bind.target = size_t(std::max(number_in(binds[b], "index", 0), 0.0f));
    bind.weight = number_in(binds[b], "weight", full) / full;
    expression.binds.push_back(bind);
  }
}

// Bones by name, as version 1 and animations list them.
void add_named_bones(File& file, const json& object, const std::string& root, Vrm& vrm) {
  const json& humanoid = object_in(file, object, "humanoid", root);
  const json& bones = object_in(file, humanoid, "humanBones", root + "/humanoid");
  for (auto it = bones.begin(); it != bones.end(); ++it) {
    std::string where = at(root + "/humanoid/humanBones", it.key());
    add_bone(file, vrm, it.key(), index_in(file, *it, "node", "nodes", where), where);
  }
}

std::string preset_of_version_0(const std::string& preset) {
  static const std::map<std::string, std::string> names = {
      {"a", "aa"}, {"i", "ih"}, {"u", "ou"}, {"e", "ee"}, {"o", "oh"}, {"joy", "happy"},
      {"angry", "angry"}, {"sorrow", "sad"}, {"fun", "relaxed"}, {"blink", "blink"},
      {"blink_l", "blinkLeft"}, {"blink_r", "blinkRight"}, {"lookup", "lookUp"},
      {"lookdown", "lookDown"}, {"lookleft", "lookLeft"}, {"lookright", "lookRight"},
      {"neutral", "neutral"}};
  auto found = names.find(preset);
  return found == names.end() ? "" : found->second;
}

void read_version_0(File& file, const json& object, Vrm& vrm) {
  const std::string root = "/extensions/VRM";
  vrm.version = 0;
  add_metadata(file, object_in(file, object, "meta", root), root, vrm);
  const json& humanoid = object_in(file, object, "humanoid", root);
  const json& bones = list_in(file, humanoid, "humanBones", root + "/humanoid");
  for (size_t i = 0; i < bones.size(); i++) {
    std::string where = at(root + "/humanoid/humanBones", i);
    add_bone(file, vrm, text_in(bones[i], "bone"), index_in(file, bones[i], "node", "nodes", where), where);
  }
  const json& master = object_in(file, object, "blendShapeMaster", root);
  const json& groups = list_in(file, master, "blendShapeGroups", root + "/blendShapeMaster");
  for (size_t g = 0; g < groups.size(); g++) {
    std::string where = at(root + "/blendShapeMaster/blendShapeGroups", g);
    VrmExpression expression;
    std::string preset = text_in(groups[g], "presetName");
    std::transform(preset.begin(), preset.end(), preset.begin(), [](unsigned char c) { return std::tolower(c); });
    expression.name = preset_of_version_0(preset);
    expression.preset = !expression.name.empty();
    // Version 0 has no preset for it, authors name it so.
    if (!expression.preset) expression.name = text_in(groups[g], "name");
    if (expression.name == "Surprised") expression = {"surprised", true, {}};
    if (groups[g].is_object())
      add_binds(file, list_in(file, groups[g], "binds", where), "mesh", "meshes", 100, where + "/binds",
                expression);
    if (groups[g].is_object() && !list_in(file, groups[g], "materialValues", where).empty())
      gltf::warn(file, where, "expressions do not change materials here");
    vrm.expressions.push_back(std::move(expression));
  }
  const json& look = object_in(file, object, "firstPerson", root);
  if (text_in(look, "lookAtTypeName") == "Bone") {
    auto gain = [&](const char* key) {
      return range_gain(object_in(file, look, key, root + "/firstPerson"), "xRange", "yRange");
    };
    vrm.eye_gain = {gain("lookAtHorizontalInner"), gain("lookAtHorizontalOuter"),
                    gain("lookAtVerticalUp"), gain("lookAtVerticalDown")};
  }
  const json& materials = list_in(file, object, "materialProperties", root);
  for (size_t m = 0; m < materials.size(); m++) {
    std::string shader = text_in(materials[m], "shader");
    if (shader.find("MToon") != std::string::npos || shader.find("Unlit") != std::string::npos)
      vrm.matt[m] = true;
  }
}

void read_version_1(File& file, const json& object, Vrm& vrm) {
  const std::string root = "/extensions/VRMC_vrm";
  vrm.version = 1;
  add_metadata(file, object_in(file, object, "meta", root), root, vrm);
  add_named_bones(file, object, root, vrm);
  const json& expressions = object_in(file, object, "expressions", root);
  for (const char* kind : {"preset", "custom"}) {
    std::string group = root + "/expressions/" + kind;
    const json& list = object_in(file, expressions, kind, root + "/expressions");
    for (auto it = list.begin(); it != list.end(); ++it) {
      VrmExpression expression{it.key(), kind[0] == 'p', {}};
      std::string where = at(group, it.key());
      if (!it->is_object()) gltf::refuse(file, where, "must be an object");
      add_binds(file, list_in(file, *it, "morphTargetBinds", where), "node", "nodes", 1,
                where + "/morphTargetBinds", expression);
      if (!list_in(file, *it, "materialColorBinds", where).empty() ||
          !list_in(file, *it, "textureTransformBinds", where).empty())
        gltf::warn(file, where, "expressions do not change materials here");
      vrm.expressions.push_back(std::move(expression));
    }
  }
  const json& look = object_in(file, object, "lookAt", root);
  if (text_in(look, "type") == "bone") {
    auto gain = [&](const char* key) {
      return range_gain(object_in(file, look, key, root + "/lookAt"), "inputMaxValue", "outputScale");
    };
    vrm.eye_gain = {gain("rangeMapHorizontalInner"), gain("rangeMapHorizontalOuter"),
                    gain("rangeMapVerticalUp"), gain("rangeMapVerticalDown")};
  }
}

void read_animation(File& file, const json& object, Vrm& vrm) {
  const std::string root = "/extensions/VRMC_vrm_animation";
  vrm.version = 1;
  vrm.animation = true;
  add_named_bones(file, object, root, vrm);
  const json& expressions = object_in(file, object, "expressions", root);
  for (const char* kind : {"preset", "custom"}) {
    const json& list = object_in(file, expressions, kind, root + "/expressions");
    for (auto it = list.begin(); it != list.end(); ++it) {
      int node = index_in(file, *it, "node", "nodes", at(root + "/expressions/" + kind, it.key()));
      if (node >= 0) vrm.expression_nodes[it.key()] = size_t(node);
    }
  }
  if (gltf::find(object, "lookAt"))
    gltf::warn(file, root + "/lookAt", "the gaze of a motion is not shown: eyes look for themselves");
}

}  // namespace

const std::set<std::string>& vrm_extensions() {
  static const std::set<std::string> known = {
      "VRM", "VRMC_vrm", "VRMC_vrm_animation", "VRMC_springBone", "VRMC_node_constraint",
      "VRMC_materials_mtoon", "VRMC_materials_hdr_emissiveMultiplier",
      "VRMC_springBone_extended_collider"};
  return known;
}

Vrm read_vrm(File& file) {
  Vrm vrm;
  if (const json* object = gltf::extension(file.root, "VRMC_vrm")) read_version_1(file, *object, vrm);
  else if (const json* older = gltf::extension(file.root, "VRM")) read_version_0(file, *older, vrm);
  else if (const json* moves = gltf::extension(file.root, "VRMC_vrm_animation"))
    read_animation(file, *moves, vrm);
  read_vrm_springs(file, vrm);
  read_vrm_constraints(file, vrm);
  const json& materials = gltf::items(file.root, "materials");
  for (size_t m = 0; m < materials.size(); m++)
    if (gltf::extension(materials[m], "VRMC_materials_mtoon") ||
        gltf::extension(materials[m], "KHR_materials_unlit"))
      vrm.matt[m] = true;
  const json& asset = file.root["asset"];
  if (std::string copyright = text_in(asset, "copyright"); !copyright.empty())
    vrm.metadata.push_back({"copyright", copyright.substr(0, 1000)});
  return vrm;
}

}  // namespace wellspring
