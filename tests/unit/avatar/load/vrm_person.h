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

// Of version 1.
inline json& presets(Asset& asset) {
  return asset.root["extensions"]["VRMC_vrm"]["expressions"]["preset"];
}

inline AppearanceChange change_of(const Character& c, const Pose& pose, size_t appearance) {
  std::vector<AppearanceChange> changes;
  eval_appearance_changes(c, pose, changes);
  EXPECT_EQ(changes.size(), c.appearances.size());
  return changes[appearance];
}

}  // namespace wellspring::test
