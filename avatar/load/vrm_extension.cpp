// SPDX-License-Identifier: Apache-2.0
#include "avatar/load/vrm_extension.h"

#include <algorithm>

#include "avatar/figure/bone_names.h"
#include "avatar/load/vrm_json.h"

namespace wellspring::avatar {
namespace {

using nlohmann::json;

using namespace vrm_json;

void add_bone(File& file, Vrm& vrm, const std::string& bone, int node, const std::string& where) {
  if (node < 0) return;
  std::string joint = vrm_bone_joint(bone, vrm.version);
  if (joint.empty())
    return gltf::warn(file, where, "unknown humanoid bone '" + bone.substr(0, 60) + "'");
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

// Names what a file says about the turns of its eyes. `input` and `output` are keys of degrees of
// gaze, and of degrees of the eye or weight of a shape.
struct RangeKeys {
  const char *inner, *outer, *up, *down, *input, *output;
};

EyeRanges read_ranges(File& file, const json& appearance, bool by_shapes, const RangeKeys& keys,
                      const std::string& where) {
  constexpr float least_input = 0.1f, most_turn = 60, degree = pi / 180;
  auto range = [&](const char* key) {
    const json& object = object_in(file, appearance, key, where);
    const json& curve = list_in(file, object, "curve", where + "/" + key);
    static const json straight = {0, 0, 0, 1, 1, 1, 1, 0};
    if (!curve.empty() && curve != straight)
      gltf::warn(file, where + "/" + key, "eyes turn evenly, not along a curve of their own");
    float input = std::clamp(number_in(object, keys.input, 90), least_input, 360.0f);
    float output = std::max(number_in(object, keys.output, by_shapes ? 1 : 10), 0.0f);
    return EyeRange{input * degree,
                    by_shapes ? std::min(output, 1.0f) : std::min(output, most_turn) * degree};
  };
  return {range(keys.inner), range(keys.outer), range(keys.up), range(keys.down), by_shapes};
}

// Reads parts that hide the head from whoever looks out of it: `of` names a node or a mesh of the
// file.
void read_first_person(File& file, const json& object, const char* of, const char* into,
                       const char* type, const std::string& where, std::set<size_t>& hidden) {
  const json& list = list_in(file, object, "meshAnnotations", where);
  for (size_t i = 0; i < list.size(); i++) {
    int index = index_in(file, list[i], of, into, at(where + "/meshAnnotations", i));
    std::string kind = text_in(list[i], type);
    if (index >= 0 && (kind == "firstPersonOnly" || kind == "FirstPersonOnly"))
      hidden.insert(size_t(index));
  }
}

// Adds bones by name, as version 1 and animations list them.
void add_named_bones(File& file, const json& object, const std::string& root, Vrm& vrm) {
  const json& humanoid = object_in(file, object, "humanoid", root);
  const json& bones = object_in(file, humanoid, "humanBones", root + "/humanoid");
  for (auto it = bones.begin(); it != bones.end(); ++it) {
    std::string where = at(root + "/humanoid/humanBones", it.key());
    add_bone(file, vrm, it.key(), index_in(file, *it, "node", "nodes", where), where);
  }
}

void read_version_0(File& file, const json& object, Vrm& vrm) {
  const std::string root = "/extensions/VRM";
  vrm.version = 0;
  add_metadata(file, object_in(file, object, "meta", root), root, vrm);
  const json& humanoid = object_in(file, object, "humanoid", root);
  const json& bones = list_in(file, humanoid, "humanBones", root + "/humanoid");
  for (size_t i = 0; i < bones.size(); i++) {
    std::string where = at(root + "/humanoid/humanBones", i);
    add_bone(file, vrm, text_in(bones[i], "bone"), index_in(file, bones[i], "node", "nodes", where),
             where);
  }
  read_vrm_expressions(file, object, vrm);
  const json& appearance = object_in(file, object, "firstPerson", root);
  constexpr RangeKeys keys{"lookAtHorizontalInner",
                           "lookAtHorizontalOuter",
                           "lookAtVerticalUp",
                           "lookAtVerticalDown",
                           "xRange",
                           "yRange"};
  std::string type = text_in(appearance, "lookAtTypeName");
  if (type == "Bone" || type == "BlendShape")
    vrm.eye_ranges =
        read_ranges(file, appearance, type == "BlendShape", keys, root + "/firstPerson");
  read_first_person(file, appearance, "mesh", "meshes", "firstPersonFlag", root + "/firstPerson",
                    vrm.hidden_meshes);
}

void read_version_1(File& file, const json& object, Vrm& vrm) {
  const std::string root = "/extensions/VRMC_vrm";
  vrm.version = 1;
  add_metadata(file, object_in(file, object, "meta", root), root, vrm);
  add_named_bones(file, object, root, vrm);
  read_vrm_expressions(file, object, vrm);
  const json& appearance = object_in(file, object, "lookAt", root);
  constexpr RangeKeys keys{"rangeMapHorizontalInner", "rangeMapHorizontalOuter",
                           "rangeMapVerticalUp",      "rangeMapVerticalDown",
                           "inputMaxValue",           "outputScale"};
  std::string type = text_in(appearance, "type");
  if (type == "bone" || type == "expression")
    vrm.eye_ranges = read_ranges(file, appearance, type == "expression", keys, root + "/lookAt");
  read_first_person(file, object_in(file, object, "firstPerson", root), "node", "nodes", "type",
                    root + "/firstPerson", vrm.hidden_nodes);
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
    gltf::warn(file, root + "/lookAt",
               "the gaze of a motion is not shown: eyes look for themselves");
}

}  // namespace

const std::set<std::string>& vrm_extensions() {
  static const std::set<std::string> known = {"VRM",
                                              "VRMC_vrm",
                                              "VRMC_vrm_animation",
                                              "VRMC_springBone",
                                              "VRMC_node_constraint",
                                              "VRMC_materials_mtoon",
                                              "VRMC_materials_hdr_emissiveMultiplier",
                                              "VRMC_springBone_extended_collider"};
  return known;
}

Vrm read_vrm(File& file) {
  Vrm vrm;
  vrm.lambertian = rewrite_vrm_materials(file);
  if (const json* object = gltf::extension(file.root, "VRMC_vrm"))
    read_version_1(file, *object, vrm);
  else if (const json* older = gltf::extension(file.root, "VRM")) read_version_0(file, *older, vrm);
  else if (const json* moves = gltf::extension(file.root, "VRMC_vrm_animation"))
    read_animation(file, *moves, vrm);
  read_vrm_springs(file, vrm);
  read_vrm_constraints(file, vrm);
  const json& asset = file.root["asset"];
  if (std::string copyright = text_in(asset, "copyright"); !copyright.empty())
    vrm.metadata.push_back({"copyright", copyright.substr(0, 1000)});
  return vrm;
}

}  // namespace wellspring::avatar
