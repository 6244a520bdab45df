// SPDX-License-Identifier: Apache-2.0
// A small person as glTF: seventeen bones whose local axes lie as the test wishes, a skin of one
// box a bone, an open mouth as morph target.
#pragma once
#include <map>

#include "base/vec.h"
#include "unit/avatar/figures.h"
#include "unit/world/load/asset.h"

namespace wellspring::test {

struct PersonBone {
  const char* vrm;     // VRM's name
  const char* parent;  // "" for the root
  vec3 place;          // facing +Z, arms in T-pose
  vec3 to;             // end of the bone's box
};

inline const std::vector<PersonBone>& person_bones() {
  static const std::vector<PersonBone> bones = {
      {"hips", "", {0, 0.95f, 0}, {0, 1.05f, 0}},
      {"spine", "hips", {0, 1.05f, 0}, {0, 1.2f, 0}},
      {"chest", "spine", {0, 1.2f, 0}, {0, 1.4f, 0}},
      {"neck", "chest", {0, 1.45f, 0}, {0, 1.52f, 0}},
      {"head", "neck", {0, 1.52f, 0}, {0, 1.75f, 0.02f}},
      {"leftUpperArm", "chest", {0.18f, 1.4f, 0}, {0.45f, 1.4f, 0}},
      {"leftLowerArm", "leftUpperArm", {0.45f, 1.4f, 0}, {0.7f, 1.4f, 0}},
      {"leftHand", "leftLowerArm", {0.7f, 1.4f, 0}, {0.85f, 1.4f, 0}},
      {"rightUpperArm", "chest", {-0.18f, 1.4f, 0}, {-0.45f, 1.4f, 0}},
      {"rightLowerArm", "rightUpperArm", {-0.45f, 1.4f, 0}, {-0.7f, 1.4f, 0}},
      {"rightHand", "rightLowerArm", {-0.7f, 1.4f, 0}, {-0.85f, 1.4f, 0}},
      {"leftUpperLeg", "hips", {0.09f, 0.92f, 0}, {0.09f, 0.5f, 0.01f}},
      {"leftLowerLeg", "leftUpperLeg", {0.09f, 0.5f, 0.01f}, {0.09f, 0.09f, 0}},
      {"leftFoot", "leftLowerLeg", {0.09f, 0.09f, 0}, {0.09f, 0.02f, 0.15f}},
      {"rightUpperLeg", "hips", {-0.09f, 0.92f, 0}, {-0.09f, 0.5f, 0.01f}},
      {"rightLowerLeg", "rightUpperLeg", {-0.09f, 0.5f, 0.01f}, {-0.09f, 0.09f, 0}},
      {"rightFoot", "rightLowerLeg", {-0.09f, 0.09f, 0}, {-0.09f, 0.02f, 0.15f}}};
  return bones;
}

struct PersonOptions {
  quat world{1, 0, 0, 0};                    // turns the whole person: facing -Z, lying in Z-up
  float unit = 1;                            // file units a metre
  quat axes{1, 0, 0, 0};                     // every bone's own axes
  bool odd_axes = false;                     // and a different turn each
  std::map<std::string, quat> posed;         // turn of a bone about world axes, after binding
  std::map<std::string, std::string> names;  // names of bones; absent: VRM's
  bool named = true;
};

inline int person_bone(const std::string& name) {
  const auto& bones = person_bones();
  for (size_t i = 0; i < bones.size(); i++)
    if (name == bones[i].vrm) return int(i);
  ADD_FAILURE() << name;
  return 0;
}

// Node i is bone i; the mesh is node 17.
inline Asset make_person(const PersonOptions& options = {}) {
  Asset asset;
  const auto& bones = person_bones();
  std::vector<mat4> bound, stands;
  std::vector<float> inverse;
  auto numbers = [](const auto& v, int n) {
    json list = json::array();
    for (int i = 0; i < n; i++) list.push_back(v[i]);
    return list;
  };
  for (size_t i = 0; i < bones.size(); i++) {
    quat own = options.axes;
    if (options.odd_axes)
      own = own * glm::angleAxis(0.7f * float(i + 1), normalize(vec3(1, float(i % 3), -0.5f)));
    mat4 bind = glm::translate(mat4(1), options.world * (bones[i].place * options.unit)) *
                glm::mat4_cast(options.world * own);
    bound.push_back(bind);
    int parent = bones[i].parent[0] ? person_bone(bones[i].parent) : -1;
    mat4 local = parent < 0 ? bind : glm::inverse(bound[size_t(parent)]) * bind;
    mat4 here = parent < 0 ? local : stands[size_t(parent)] * local;
    auto turned = options.posed.find(bones[i].vrm);
    if (turned != options.posed.end()) {
      mat4 turn = glm::mat4_cast(options.world * turned->second * glm::conjugate(options.world));
      vec4 place = here[3];
      here[3] = vec4(0, 0, 0, 1);
      here = turn * here;
      here[3] = place;
      local = parent < 0 ? here : glm::inverse(stands[size_t(parent)]) * here;
    }
    stands.push_back(here);
    quat rotation = glm::normalize(glm::quat_cast(local));
    json node = {{"translation", numbers(local[3], 3)},
                 {"rotation", {rotation.x, rotation.y, rotation.z, rotation.w}}};
    auto name = options.names.find(bones[i].vrm);
    if (options.named) node["name"] = name == options.names.end() ? bones[i].vrm : name->second;
    for (size_t c = 0; c < bones.size(); c++)
      if (std::string(bones[c].parent) == bones[i].vrm) node["children"].push_back(c);
    asset.root["nodes"].push_back(node);
    mat4 back = glm::inverse(bind);
    for (int k = 0; k < 16; k++) inverse.push_back(back[k / 4][k % 4]);
  }
  // One box a bone, 6 cm thick.
  std::vector<float> positions, normals, weights, open;
  std::vector<uint16_t> joints, indices;
  for (size_t i = 0; i < bones.size(); i++)
    for (int corner = 0; corner < 8; corner++) {
      vec3 offset((corner & 1) ? 0.03f : -0.03f, (corner & 2) ? 0.03f : -0.03f,
                  (corner & 4) ? 0.03f : -0.03f);
      vec3 p = ((corner & 1) ? bones[i].to : bones[i].place) + offset;
      vec3 n = options.world * normalize(offset);
      vec3 move =
          std::string(bones[i].vrm) == "head" && !(corner & 2) ? vec3(0, -0.02f, 0) : vec3(0);
      p = options.world * (p * options.unit), move = options.world * (move * options.unit);
      for (int k = 0; k < 3; k++)
        positions.push_back(p[k]), normals.push_back(n[k]), open.push_back(move[k]);
      for (int k = 0; k < 4; k++)
        weights.push_back(k ? 0.0f : 1.0f), joints.push_back(uint16_t(k ? 0 : i));
      if (corner) continue;
      for (int face : {0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1,
                       2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3})
        indices.push_back(uint16_t(i * 8 + size_t(face)));
    }
  size_t count = bones.size() * 8;
  json primitive;
  primitive["attributes"]["POSITION"] = asset.add_floats("VEC3", 3, positions);
  primitive["attributes"]["NORMAL"] = asset.add_floats("VEC3", 3, normals);
  primitive["attributes"]["WEIGHTS_0"] = asset.add_floats("VEC4", 4, weights);
  primitive["attributes"]["JOINTS_0"] =
      asset.add_accessor(asset.add_view(joints), 5123, "VEC4", count);
  primitive["indices"] =
      asset.add_accessor(asset.add_view(indices), 5123, "SCALAR", indices.size());
  json target;
  target["POSITION"] = asset.add_floats("VEC3", 3, open);
  primitive["targets"] = json::array({target});
  asset.root["meshes"].push_back(
      {{"primitives", {primitive}}, {"extras", {{"targetNames", {"MouthOpen"}}}}});
  json joint_list = json::array();
  for (size_t i = 0; i < bones.size(); i++) joint_list.push_back(i);
  asset.root["skins"].push_back(
      {{"joints", joint_list}, {"inverseBindMatrices", asset.add_floats("MAT4", 16, inverse)}});
  asset.root["nodes"].push_back({{"mesh", 0}, {"skin", 0}, {"name", "Body"}});
  asset.root["scene"] = 0;
  asset.root["scenes"] = json::array({{{"nodes", {0, 17}}}});
  return asset;
}

inline void add_vrm_1(Asset& asset) {
  json bones;
  for (size_t i = 0; i < person_bones().size(); i++) bones[person_bones()[i].vrm] = {{"node", i}};
  asset.root["extensionsUsed"].push_back("VRMC_vrm");
  asset.root["extensions"]["VRMC_vrm"] = {
      {"specVersion", "1.0"},
      {"meta",
       {{"name", "Ada"},
        {"authors", {"A. Author", "B. Author"}},
        {"licenseUrl", "https://vrm.dev/licenses/1.0/"}}},
      {"humanoid", {{"humanBones", bones}}},
      {"lookAt",
       {{"type", "bone"},
        {"rangeMapHorizontalInner", {{"inputMaxValue", 90}, {"outputScale", 9}}}}},
      {"expressions",
       {{"preset",
         {{"aa", {{"morphTargetBinds", {{{"node", 17}, {"index", 0}, {"weight", 0.5}}}}}}}}}}};
}

inline void add_vrm_0(Asset& asset) {
  json bones = json::array();
  for (size_t i = 0; i < person_bones().size(); i++)
    bones.push_back({{"bone", person_bones()[i].vrm}, {"node", i}});
  asset.root["extensionsUsed"].push_back("VRM");
  asset.root["extensions"]["VRM"] = {
      {"meta", {{"title", "Ada"}, {"author", "A. Author"}, {"licenseName", "CC0"}}},
      {"humanoid", {{"humanBones", bones}}},
      {"blendShapeMaster",
       {{"blendShapeGroups",
         {{{"name", "A"},
           {"presetName", "a"},
           {"binds", {{{"mesh", 0}, {"index", 0}, {"weight", 50}}}}}}}}},
      {"secondaryAnimation", {{"boneGroups", {{{"bones", {0}}}}}}},
      {"materialProperties", json::array()}};
}

inline Character load_asset(const Asset& asset, bool binary = true) {
  return load_text(binary ? asset.glb() : asset.gltf(), ".glb");
}

}  // namespace wellspring::test
