// SPDX-License-Identifier: Apache-2.0
// What check says of places, size and light.
#include "show/check/check_scene.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "light/kept/bake_file.h"
#include "light/kept/bake_scene.h"
#include "light/kept/finish_bake.h"
#include "light/kept/map_file.h"
#include "show/exhibit/exhibit_lights.h"
#include "unit/show/exhibit/room_package.h"
#include "unit/show/tiny_exhibit.h"

namespace wellspring::test {
namespace {

TEST(CheckScene, AGoodRoomIsGood) {
  RoomPackage package;
  package.check();
  EXPECT_EQ(package.told(), "");
}

// The light of a room, of one that was painted since, and a file that is cut off.
TEST(CheckScene, StaleOrDamagedLightIsNamed) {
  RoomPackage package;
  Exhibit exhibit = package.read();
  std::vector<Problem> problems;
  check_shipped_light(exhibit, problems);
  EXPECT_TRUE(problems.empty()) << "none is shipped";
  const World world(exhibit.scene);
  const BakeScene scene = make_bake_scene(world, {});
  const std::string file = shipped_light(exhibit.folder);
  ASSERT_TRUE(save_map(world, *scene.known, file, hash_scene(exhibit.scene)));
  check_shipped_light(exhibit, problems);
  EXPECT_TRUE(problems.empty());
  exhibit.scene.materials.back().base_color.x *= 0.5f;
  check_shipped_light(exhibit, problems);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].what.find("stale"), std::string::npos) << problems[0].what;
  EXPECT_EQ(problems[0].file, file);
  std::filesystem::resize_file(file, 200);
  exhibit.scene.materials.back().base_color.x *= 2;
  check_shipped_light(exhibit, problems);
  ASSERT_EQ(problems.size(), 2u);
  EXPECT_NE(problems[1].what.find("damaged"), std::string::npos) << problems[1].what;
}

TEST(CheckScene, SeesWhoIsInSolidMatter) {
  RoomPackage package;
  package.manifest["viewpoints"].push_back({{"name", "in"}, {"position", {0, 0.4, -0.5}}});
  package.manifest["viewpoints"].push_back({{"name", "beside"}, {"position", {0, 0.4, 0.5}}});
  package.check();
  EXPECT_EQ(package.says("/viewpoints/1/position", "inside 'Table'"), 1) << package.told();
  EXPECT_EQ(package.problems.size(), 1u) << package.told();
}

TEST(CheckScene, ARoomWithItsBacksInwardsIsSaid) {
  Asset asset;
  add_box(asset, "Cube", {-4, 0, -3}, {4, 3, 3}, false);
  add_point_light(asset, "Lamp", {0, 2.6f, 0}, 8);
  RoomPackage package(asset);
  package.check();
  EXPECT_EQ(package.says("/viewpoints/0/position", "faces inwards"), 1) << package.told();
}

TEST(CheckScene, ACeilingThatFacesAwayIsSaid) {
  for (bool away : {false, true}) {
    Asset asset = room_asset(0);
    add_box(asset, "Vault", {-4, 2.9f, -3}, {4, 2.95f, 3}, away);
    add_point_light(asset, "Lamp", {0, 2.6f, 0}, 8);
    RoomPackage package(asset);
    package.check();
    EXPECT_EQ(package.says("/scene", "from behind, where no light is baked: 'Vault'"), away)
        << package.told();
  }
}

TEST(CheckScene, MirroredNodesKeepTheirSides) {
  Asset asset = room_asset(0);
  add_point_light(asset, "Lamp", {0, 2.6f, 0}, 8);
  for (json& node : asset.root["nodes"])
    if (node.contains("mesh")) node["scale"] = {-1, 1, 1};
  RoomPackage package(asset);
  package.manifest["viewpoints"].push_back({{"name", "in"}, {"position", {0, 0.4, -0.5}}});
  package.check();
  EXPECT_EQ(package.says("/viewpoints/0/position", ""), 0) << package.told();
  EXPECT_EQ(package.says("/viewpoints/1/position", "inside"), 1) << package.told();
}

TEST(CheckScene, SeesStorytellersInSolidMatter) {
  RoomPackage package;
  Exhibit exhibit = package.read();
  World world(exhibit.scene);
  add_storyteller(exhibit, "buried", {0, -0.5, -0.5});
  add_storyteller(exhibit, "free", {2, 0, 1});
  check_places(exhibit, world, package.problems);
  EXPECT_EQ(package.says("/storyteller", "'buried' stands inside 'Table'"), 1) << package.told();
  EXPECT_EQ(package.problems.size(), 1u) << package.told();
}

TEST(CheckScene, SeesWhoLooksAtNothing) {
  RoomPackage package;
  package.manifest["viewpoints"].push_back(
      {{"name", "lost"}, {"position", {0, 1.65, 50}}, {"yaw_deg", 180}});
  package.check();
  EXPECT_EQ(package.says("/viewpoints/1/position", "nothing of the scene is in view"), 1)
      << package.told();
  EXPECT_EQ(package.says("/viewpoints/0/position", ""), 0);
}

TEST(CheckScene, SizesThatAreNoMetresAreSaid) {
  for (auto [size, scale] : {std::pair(0.01f, "\"scale\": 100"), std::pair(3000.0f, "0.01")}) {
    Asset asset;
    add_box(asset, "Box", vec3(0), vec3(size), false);
    add_point_light(asset, "Lamp", vec3(2 * size), 8 * size * size);
    RoomPackage package(asset);
    package.check();
    EXPECT_EQ(package.says("/scene", scale), 1) << package.told();
  }
  EXPECT_EQ(propose_scale(8, 1.65), 1);
  EXPECT_EQ(propose_scale(0.3, 1.65), 1) << "a small object";
  EXPECT_EQ(propose_scale(300, 1.65), 1) << "a big building";
  EXPECT_EQ(propose_scale(8000, 1.65), 0.001) << "millimetres";
}

TEST(CheckScene, LampsHundredsOfTimesTooBrightAreNamed) {
  RoomPackage package(
      room_asset(100 * 683 / (4 * pi)));  // 100 W in Blender's lighting mode Standard
  Exhibit exhibit = package.check();
  EXPECT_EQ(package.says("/scene", "'Lamp'"), 1) << package.told();
  EXPECT_EQ(package.says("/exposure", "white"), 1) << package.told();
  package.manifest["light_scale"] = 1.0 / 683;
  package.check();
  EXPECT_EQ(package.told(), "");
  package.manifest.erase("light_scale");
  package.manifest["exposure"] = "auto";
  package.check();
  EXPECT_EQ(package.told(), "");
}

TEST(CheckScene, ARoomThatIsFarTooDarkIsSaid) {
  RoomPackage package(room_asset(0.002f));
  package.check();
  EXPECT_EQ(package.says("/exposure", "black"), 1) << package.told();
}

TEST(ExhibitLight, AutoFollowsTheLightAndIsTheSameEachTime) {
  RoomPackage package(room_asset(8)), bright(room_asset(800));
  package.manifest["exposure"] = bright.manifest["exposure"] = "auto";
  float one = package.read().exposure, other = bright.read().exposure;
  EXPECT_TRUE(package.read().auto_exposure);
  EXPECT_EQ(one, package.read().exposure);
  EXPECT_NEAR(one / other, 100, 1);
  EXPECT_GT(one, 0.1f);
  EXPECT_LT(one, 10.0f);
}

TEST(ExhibitLight, DarkThingsStayDark) {
  Asset white = room_asset(), black = room_asset();
  // Both rooms have the same light: nearly all of it comes from the lamp, not from walls.
  for (json& material : white.root["materials"])
    material["pbrMetallicRoughness"]["baseColorFactor"] = {0.2, 0.2, 0.2, 1};
  for (json& material : black.root["materials"])
    material["pbrMetallicRoughness"]["baseColorFactor"] = {0.1, 0.1, 0.1, 1};
  RoomPackage light(white), dark(black);
  light.manifest["exposure"] = dark.manifest["exposure"] = "auto";
  EXPECT_NEAR(dark.read().exposure / light.read().exposure, 1, 0.35);
}

TEST(ExhibitLight, LampsThatAreOffAtFirstDoNotCount) {
  Asset asset = room_asset(8);
  add_point_light(asset, "Floodlight", {0, 2.6f, 0}, 72);  // ten times as bright with it
  RoomPackage package(asset);
  package.manifest["exposure"] = "auto";
  float bright = package.read().exposure;
  package.manifest["lamps"] = json::array(
      {{{"id", "f"}, {"title", {{"en", "F"}}}, {"nodes", {"Floodlight"}}, {"on", false}}});
  float dim = package.read().exposure;
  EXPECT_EQ(package.told(), "");
  EXPECT_NEAR(dim / bright, 10, 0.5);
}

TEST(ExhibitLight, ExposureIsANumberOrAuto) {
  RoomPackage package;
  EXPECT_EQ(package.read().exposure, 1);
  package.manifest["exposure"] = 2.5;
  EXPECT_EQ(package.read().exposure, 2.5f);
  EXPECT_EQ(package.told(), "");
  package.manifest["exposure"] = "bright";
  package.read();
  EXPECT_EQ(package.says("/exposure", "\"auto\""), 1);
}

TEST(ExhibitLight, ASceneWithoutAnyIsLitFromEverywhereAndSaysSo) {
  RoomPackage package(room_asset(0));
  Exhibit exhibit = package.read();
  EXPECT_EQ(exhibit.scene.environment.radiance, vec3(1));
  EXPECT_EQ(package.says("/environment", "no light of any kind"), 1) << package.told();
}

TEST(ExhibitLight, LightScaleIsOnLampsAndEmissionOfTheFile) {
  Asset asset = room_asset(8);
  asset.root["materials"][1]["emissiveFactor"] = {1, 0.5, 0};
  RoomPackage package(asset);
  package.manifest["light_scale"] = 0.25;
  package.manifest["environment"] = {{"radiance", {0.5, 0.5, 0.5}}};
  Exhibit exhibit = package.read();
  EXPECT_EQ(exhibit.scene.lights.at(0).intensity, vec3(2));
  bool found = false;
  for (const Material& material : exhibit.scene.materials)
    found |= material.emission == vec3(0.25f, 0.125f, 0);
  EXPECT_TRUE(found);
  EXPECT_EQ(exhibit.scene.environment.radiance, vec3(0.5f));
}

}  // namespace
}  // namespace wellspring::test
