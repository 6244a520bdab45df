// SPDX-License-Identifier: Apache-2.0
// The small person of gltf_person.h as a VRM model whose expressions change its materials.
#pragma once
#include <vector>

#include "avatar/face/expression_rules.h"
#include "unit/avatar/load/gltf_person.h"

namespace wellspring::test {

// A person of two materials: skin, which the body wears, and a ring.
inline Asset dressed_person() {
  Asset asset = make_person();
  asset.root["materials"] = {
      {{"name", "skin"},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {0.5, 0.4, 0.25, 0.5}},
         {"baseColorTexture",
          {{"index", 0},
           {"extensions",
            {{"KHR_texture_transform",
              {{"scale", {2, 0.5}}, {"offset", {0.25, 0}}, {"rotation", 0.3}}}}}}}}},
       {"emissiveFactor", {0.1, 0, 0}},
       {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}}}}},
      {{"name", "ring"}}};
  asset.root["textures"] = json::array({json::object()});
  asset.root["extensionsUsed"] = {"KHR_texture_transform", "KHR_materials_emissive_strength"};
  asset.root["meshes"][0]["primitives"][0]["material"] = 0;
  return asset;
}

// Returns the expressions of version 1.
inline json& presets(Asset& asset) {
  return asset.root["extensions"]["VRMC_vrm"]["expressions"]["preset"];
}

// People whose extensions have every field that the format has.
inline Asset full_person_1() {
  Asset asset = dressed_person();
  add_vrm_1(asset);
  json color = {{"material", 0}, {"type", "color"}, {"targetValue", {1, 0, 0.25, 1}}};
  presets(asset)["happy"] = {
      {"isBinary", true},
      {"overrideBlink", "block"},
      {"overrideLookAt", "blend"},
      {"materialColorBinds", {color}},
      {"textureTransformBinds", {{{"material", 0}, {"scale", {3, 0.5}}, {"offset", {0.75, 0.5}}}}}};
  presets(asset)["blink"] = presets(asset)["aa"];
  asset.root["extensions"]["VRMC_vrm"]["firstPerson"]["meshAnnotations"] = {
      {{"node", 17}, {"type", "both"}}};
  asset.root["nodes"][3]["extensions"]["VRMC_node_constraint"] = {
      {"specVersion", "1.0"},
      {"constraint", {{"roll", {{"source", 2}, {"rollAxis", "Y"}, {"weight", 0.5}}}}}};
  asset.root["nodes"][7]["extensions"]["VRMC_node_constraint"] = {
      {"specVersion", "1.0"}, {"constraint", {{"aim", {{"source", 4}, {"aimAxis", "PositiveX"}}}}}};
  asset.root["materials"][0]["extensions"]["VRMC_materials_mtoon"] = {
      {"outlineWidthMode", "none"}, {"shadeColorFactor", {0, 0, 0}}};
  return asset;
}

inline Asset full_person_0() {
  Asset asset = dressed_person();
  add_vrm_0(asset);
  auto& vrm = asset.root["extensions"]["VRM"];
  vrm["blendShapeMaster"]["blendShapeGroups"][0]["materialValues"] = {
      {{"materialName", "skin"}, {"propertyName", "_Color"}, {"targetValue", {0.5, 0, 1, 1}}},
      {{"materialName", "skin"},
       {"propertyName", "_MainTex_ST"},
       {"targetValue", {1, 0.25, 0.5, 0.25}}}};
  vrm["firstPerson"] = {{"lookAtTypeName", "BlendShape"},
                        {"lookAtVerticalUp", {{"xRange", 60}, {"yRange", 1}}},
                        {"meshAnnotations", {{{"mesh", 0}, {"firstPersonFlag", "Auto"}}}}};
  vrm["materialProperties"] = {
      {{"shader", "VRM/MToon"},
       {"floatProperties", {{"_Cutoff", 0.5}}},
       {"vectorProperties", {{"_Color", {1, 1, 1, 1}}, {"_MainTex", {0, 0, 1, 1}}}},
       {"textureProperties", {{"_MainTex", 0}}},
       {"keywordMap", {{"_ALPHATEST_ON", true}}}}};
  return asset;
}

inline AppearanceChange change_of(const Character& c, const Pose& pose, size_t appearance) {
  std::vector<AppearanceChange> changes;
  eval_appearance_changes(c, pose, changes);
  EXPECT_EQ(changes.size(), c.appearances.size());
  return changes[appearance];
}

}  // namespace wellspring::test
