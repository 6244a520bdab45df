// SPDX-License-Identifier: Apache-2.0
// Materials of glTF figures come from the reader that scenes use.
#include <gtest/gtest.h>

#include "avatar/character_load.h"
#include "show/figure.h"
#include "unit/avatar/gltf_person.h"

namespace wellspring {
namespace {

struct Made {
  Character character;
  Scene scene;
  std::vector<Mesh> moving;
  std::vector<uint32_t> objects;
};

Made make(const Asset& asset, const std::map<std::string, std::string>& files = {}) {
  TempFolder folder;
  for (const auto& [name, bytes] : files) folder.write(name, bytes);
  Made made;
  made.character = load_character(folder.write("person.glb", asset.glb()));
  made.scene.materials.push_back({});
  make_figure(made.character, made.scene, made.moving, made.objects);
  return made;
}

Asset painted(const json& material) {
  Asset asset = test::make_person();
  asset.root["materials"] = json::array({material});
  asset.root["meshes"][0]["primitives"][0]["material"] = 0;
  return asset;
}

const Material& worn(const Made& made) { return made.scene.materials[size_t(made.moving[0].material)]; }

bool says(const Made& made, const std::string& text) {
  for (const std::string& warning : made.scene.warnings)
    if (warning.find(text) != std::string::npos) return true;
  return false;
}

TEST(FigureOfGltf, WearsTheFilesMaterial) {
  Made made = make(painted({{"name", "silk"},
                            {"alphaMode", "MASK"},
                            {"pbrMetallicRoughness", {{"baseColorFactor", {0.2, 0.4, 0.6, 1}}, {"roughnessFactor", 0.3}}},
                            {"extensions", {{"KHR_materials_sheen", {{"sheenColorFactor", {1, 0, 0}}}}}}}));
  ASSERT_EQ(made.moving.size(), 1u);
  EXPECT_EQ(worn(made).name, "silk");
  EXPECT_FLOAT_EQ(worn(made).base_color.y, 0.4f);
  EXPECT_FLOAT_EQ(worn(made).roughness, 0.3f);
  EXPECT_FLOAT_EQ(worn(made).sheen_color.x, 1);
  EXPECT_EQ(worn(made).alpha_mode, AlphaMode::mask);
  EXPECT_EQ(made.scene.materials[0].name, "") << "the scene's own stay";
}

TEST(FigureOfGltf, CartoonsAreShownMatt) {
  Made made = make(painted({{"name", "toon"},
                            {"pbrMetallicRoughness", {{"baseColorFactor", {0.2, 0.4, 0.6, 1}}}},
                            {"extensions", {{"KHR_materials_unlit", json::object()}}}}));
  EXPECT_FALSE(worn(made).unlit);
  EXPECT_FLOAT_EQ(worn(made).metallic, 0);
  EXPECT_FLOAT_EQ(worn(made).roughness, 1);
  bool said = false;
  for (const std::string& warning : made.character.warnings) said = said || warning.find("cartoons") != std::string::npos;
  EXPECT_TRUE(said);
}

TEST(FigureOfGltf, MissingAndBrokenPicturesAreTold) {
  Asset asset = painted({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}, {"baseColorFactor", {0.5, 0.5, 0.5, 1}}}}});
  asset.root["textures"] = json::array({{{"source", 0}}});
  asset.root["images"] = json::array({{{"uri", "face.png"}}});
  Made missing = make(asset);
  EXPECT_EQ(worn(missing).base_color_texture.texture, -1);
  EXPECT_FLOAT_EQ(worn(missing).base_color.x, 0.5f);
  EXPECT_TRUE(says(missing, "no such picture: face.png"));
  Made broken = make(asset, {{"face.png", "\x89PNG\r\n\x1a\nnothing"}});
  EXPECT_EQ(worn(broken).base_color_texture.texture, -1);
  EXPECT_TRUE(says(broken, "cannot be decoded"));
}

}  // namespace
}  // namespace wellspring
