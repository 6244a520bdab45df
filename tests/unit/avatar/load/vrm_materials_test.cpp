// SPDX-License-Identifier: Apache-2.0
// Cartoon materials of VRM models as glTF's own.
#include <gtest/gtest.h>

#include "avatar/load/character_load.h"
#include "avatar/load/vrm_extension.h"
#include "avatar/load/vrm_json.h"
#include "base/load_error.h"
#include "unit/avatar/figures.h"
#include "unit/avatar/load/vrm_person.h"

namespace wellspring::test {
namespace {

using test::add_vrm_0;
using test::add_vrm_1;

gltf::File rewritten(const Asset& asset) {
  test::TemporaryFile temporary(asset.glb(), ".glb");
  gltf::File file = gltf::load_gltf(temporary.path(), "", vrm_extensions());
  rewrite_vrm_materials(file);
  return file;
}

// A person of VRM 0 with a cartoon material and an unlit one.
Asset cartoon_person() {
  Asset asset = dressed_person();
  add_vrm_0(asset);
  asset.root["extensions"]["VRM"]["materialProperties"] = {
      {{"name", "skin"},
       {"shader", "VRM/MToon"},
       {"floatProperties",
        {{"_Cutoff", 0.25},
         {"_CullMode", 0},
         {"_BumpScale", 0.5},
         {"_OutlineWidthMode", 1},
         {"_OutlineWidth", 0.1}}},
       {"vectorProperties",
        {{"_Color", {0.5, 1, 0, 0.75}},
         {"_EmissionColor", {0, 1, 0, 1}},
         {"_MainTex", {0.125, 0.25, 2, 0.5}}}},
       {"textureProperties", {{"_MainTex", 0}, {"_BumpMap", 0}, {"_EmissionMap", 0}}},
       {"keywordMap", {{"_ALPHATEST_ON", true}}}},
      {{"name", "ring"},
       {"shader", "VRM/UnlitTransparent"},
       {"floatProperties", json::object()},
       {"vectorProperties", json::object()},
       {"textureProperties", {{"_MainTex", 0}}}}};
  return asset;
}

TEST(VrmMaterials, OfVersion0AreAsTheirShaderHasThem) {
  Asset asset = cartoon_person();
  gltf::File file = rewritten(asset);
  const json& skin = file.root["materials"][0];
  EXPECT_EQ(skin["alphaMode"], "MASK");
  EXPECT_EQ(skin["alphaCutoff"], 0.25);
  EXPECT_EQ(skin["doubleSided"], true);
  const json& pbr = skin["pbrMetallicRoughness"];
  EXPECT_NEAR(pbr["baseColorFactor"][0].get<float>(), 0.21404f, 1e-4f);
  EXPECT_EQ(pbr["baseColorFactor"][3], 0.75);
  for (const json* picture :
       {&pbr["baseColorTexture"], &skin["normalTexture"], &skin["emissiveTexture"]}) {
    const json& lies = (*picture)["extensions"]["KHR_texture_transform"];
    EXPECT_EQ(lies["scale"], json({2, 0.5}));
    EXPECT_EQ(lies["offset"], json({0.125, 0.25})) << "1 - 0.5 - 0.25";
  }
  EXPECT_EQ(skin["normalTexture"]["scale"], 0.5);
  EXPECT_EQ(skin["emissiveFactor"], json({0, 1, 0}));
  EXPECT_EQ(file.root["materials"][1]["alphaMode"], "BLEND");
  Character c = load_asset(asset);
  EXPECT_TRUE(says(c, "outlines of cartoon materials (MToon) are not drawn"));
  EXPECT_TRUE(says(c, "are shown matt"));
  ASSERT_EQ(c.appearances.size(), 3u);
  EXPECT_TRUE(c.appearances[1].lambertian && c.appearances[2].lambertian);
  EXPECT_TRUE(c.appearances[1].double_sided);
}

TEST(VrmMaterials, OfVersion0FollowKeywordsAndTheShaderThatTheyName) {
  Asset asset = cartoon_person();
  auto& properties = asset.root["extensions"]["VRM"]["materialProperties"];
  properties[0]["keywordMap"] = {{"_ALPHABLEND_ON", true}};
  properties[0]["floatProperties"]["_CullMode"] = 2;
  properties[0]["vectorProperties"].erase("_EmissionColor");
  gltf::File file = rewritten(asset);
  EXPECT_EQ(file.root["materials"][0]["alphaMode"], "BLEND");
  EXPECT_EQ(file.root["materials"][0]["doubleSided"], false);
  EXPECT_FALSE(file.root["materials"][0].contains("emissiveFactor"))
      << "MToon's counts: it glows not";
  properties[0]["shader"] = "VRM_USE_GLTFSHADER";
  file = rewritten(asset);
  EXPECT_EQ(file.root["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"][0], 0.5)
      << "glTF's own counts";
  properties[0]["shader"] = "VRM/MToon";
  properties[0]["textureProperties"]["_MainTex"] = 7;
  EXPECT_THROW(load_asset(asset), LoadError);
}

TEST(VrmMaterials, OfVersion1TellWhatIsNotDrawn) {
  Asset asset = dressed_person();
  add_vrm_1(asset);
  asset.root["materials"][0]["extensions"]["VRMC_materials_mtoon"] = {
      {"specVersion", "1.0"},
      {"outlineWidthMode", "worldCoordinates"},
      {"outlineWidthFactor", 0.01},
      {"uvAnimationScrollXSpeedFactor", 0.1},
      {"matcapTexture", {{"index", 0}}}};
  asset.root["materials"][1]["extensions"]["VRMC_materials_hdr_emissiveMultiplier"] = {
      {"emissiveMultiplier", 3}};
  Character c = load_asset(asset);
  for (const char* what : {"outlines of", "moving pictures of", "matcaps of"})
    EXPECT_TRUE(says(c, what)) << what;
  EXPECT_FALSE(says(c, "rims of"));
  EXPECT_EQ(rewritten(asset).root["materials"][1]["extensions"]["KHR_materials_emissive_strength"]
                                 ["emissiveStrength"],
            3.0);
}

TEST(VrmMaterials, MToonIgnoresColoursOfVertices) {
  Asset asset = dressed_person();
  std::vector<float> red;
  for (size_t v = 0; v < test::person_bones().size() * 8; v++) red.insert(red.end(), {1, 0, 0, 1});
  asset.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
      asset.add_floats("VEC4", 4, red);
  Asset newer = asset;
  add_vrm_0(asset);
  EXPECT_FALSE(load_asset(asset).colors.empty());
  asset.root["extensions"]["VRM"]["materialProperties"] = {{{"shader", "VRM/MToon"}}};
  EXPECT_TRUE(load_asset(asset).colors.empty());
  newer.root["materials"][0]["extensions"]["VRMC_materials_mtoon"] = json::object();
  EXPECT_TRUE(load_asset(newer).colors.empty());
}

TEST(VrmMaterials, UnityColoursAreLinear) {
  EXPECT_EQ(linear_of_unity(vec3(0, -1, NAN)), vec3(0));
  vec3 made = linear_of_unity(vec3(0.04f, 0.5f, 1));
  EXPECT_NEAR(made.x, 0.04f / 12.92f, 1e-7f);
  EXPECT_NEAR(made.y, 0.2140411f, 1e-6f);
  EXPECT_NEAR(made.z, 1, 1e-6f);
  EXPECT_NEAR(linear_of_unity(vec3(2)).x, std::pow(2.0f, 2.2f), 1e-5f);
}

}  // namespace
}  // namespace wellspring::test
