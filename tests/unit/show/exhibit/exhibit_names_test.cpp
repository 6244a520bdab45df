// SPDX-License-Identifier: Apache-2.0
// Names in exhibit.json and in stories that are not there, and what was meant; files of several.
#include <gtest/gtest.h>

#include "avatar/body/gesture.h"
#include "avatar/face/expression.h"
#include "avatar/story/story_speech.h"
#include "unit/show/exhibit/room_package.h"

using namespace wellspring;

using namespace wellspring::test;

TEST(ExhibitNames, ParentsWithoutAMeshAreNodes) {
  Asset asset = room_asset();
  int table = 1;
  asset.root["nodes"].push_back({{"name", "Furniture"}, {"children", {table}}});
  asset.root["scenes"][0]["nodes"] = {0, 2, 3};
  asset.root["nodes"].push_back({{"name", "Nowhere"}});
  asset.root["scenes"][0]["nodes"].push_back(4);
  RoomPackage package(asset);
  package.manifest["objects"] = {{"all", {{"node", "Furniture"}}}};
  Exhibit exhibit = package.read();
  EXPECT_EQ(package.told(), "");
  EXPECT_EQ(exhibit.points.at(0).place, dvec3(vec3(0, 0.4f, -0.5f)));
  EXPECT_EQ(exhibit.scene.objects.at(exhibit.points[0].objects.front()), "Table");
  package.manifest["objects"] = {{"a", {{"node", "Nowhere"}}}, {"b", {{"node", "Funriture"}}}};
  package.read();
  EXPECT_EQ(package.says("/objects/a/node", "nothing that can be seen"), 1) << package.told();
  EXPECT_EQ(package.says("/objects/b/node", "did you mean 'Furniture'?"), 1) << package.told();
}

TEST(ExhibitNames, AccentsMayStandApart) {
  Asset asset = room_asset();
  asset.root["nodes"][1]["name"] = "Stu\u030al";
  RoomPackage package(asset);
  package.manifest["objects"] = {{"chair", {{"node", "St\u016fl"}}}};
  EXPECT_EQ(package.read().points.at(0).objects.size(), 1u);
  EXPECT_EQ(package.told(), "");
}

TEST(ExhibitNames, BackFacesAreDrawnWhereTheExhibitSaysSo) {
  RoomPackage package;
  EXPECT_TRUE(package.read().scene.cull_back_faces);
  package.manifest["draw_back_faces"] = true;
  EXPECT_FALSE(package.read().scene.cull_back_faces);
  EXPECT_EQ(package.told(), "");
}

TEST(ExhibitNames, NothingIsMissedInASceneThatCannotBeRead) {
  RoomPackage package;
  package.write("scene.gltf", "{");
  package.manifest["objects"] = {{"table", {{"node", "Table"}}}};
  package.manifest["lamps"] =
      nlohmann::json::array({{{"id", "l"}, {"title", {{"en", "L"}}}, {"nodes", {"Lamp"}}}});
  package.read();
  EXPECT_EQ(package.told().find("no node"), std::string::npos) << package.told();
  EXPECT_EQ(package.problems.size(), 1u) << package.told();
}

TEST(ExhibitNames, JsonErrorsHaveLineAndColumn) {
  RoomPackage package;
  package.write("exhibit.json", "{\n  \"title\": \"x\",\n  \"scene\": ]\n}");
  read_exhibit(package.folder.file("room"), package.problems);
  EXPECT_EQ(package.says("", "not JSON at line 3, column 12"), 1) << package.told();
}

TEST(ExhibitNames, WhatWasMeantIsProposed) {
  RoomPackage package;
  package.manifest["start"] = "dor";
  package.manifest["viewpoint"] = 1;
  package.manifest["objects"] = {{"table", {{"node", "Table"}}}};
  package.manifest["lamps"] =
      nlohmann::json::array({{{"id", "l"}, {"title", {{"en", "L"}}}, {"nodes", {"lmap"}}}});
  package.manifest["stories"] = {{{"id", "s"}, {"text", {{"en", "s.story"}}}}};
  package.write("s.story",
                "<story>\n<p><gesture name=\"point_fra\"/>One.</p>\n<p><emotion "
                "name=\"jyo\"/>Two.</p>\n<p><look at=\"tabel\"/>Three.</p>\n<p><view "
                "name=\"doors\"/>Four.</p>\n</story>");
  package.read();
  EXPECT_EQ(package.says("/start", "did you mean 'door'?"), 1) << package.told();
  EXPECT_EQ(package.says("/viewpoint", "did you mean 'viewpoints'?"), 1);
  EXPECT_EQ(package.says("/lamps/0/nodes/0", "did you mean 'Lamp'?"), 1);
  const std::string told = package.told();
  for (const char* line : {"line 2", "line 3", "line 4", "line 5"})
    EXPECT_NE(told.find(std::string("s.story: ") + line), std::string::npos) << told;
  for (const char* name : {"point_far", "joy", "table", "door"})
    EXPECT_NE(told.find(std::string("did you mean '") + name + "'?"), std::string::npos) << name;
}

TEST(ExhibitNames, EveryMarkThatTheGuideShowsExists) {
  std::ifstream file(std::string(WELLSPRING_SOURCE) + "/docs/stories.md");
  const std::string guide{std::istreambuf_iterator<char>(file), {}};
  int count = 0;
  auto names_of = [&](const std::string& begin) {
    std::vector<std::string> names;
    for (size_t at = guide.find(begin); at != std::string::npos; at = guide.find(begin, at + 1)) {
      size_t from = at + begin.size();
      names.push_back(guide.substr(from, guide.find('"', from) - from));
      count++;
    }
    return names;
  };
  for (const std::string& name : names_of("<gesture name=\""))
    EXPECT_GE(find_gesture(name), 0) << name;
  for (const std::string& name : names_of("<emotion name=\""))
    EXPECT_TRUE(find_emotion(name) >= 0 || name == "neutral") << name;
  EXPECT_GE(count, 5);
}

TEST(ExhibitFiles, SeveralStandWhereTheyAreTold) {
  RoomPackage package;
  Asset vase;
  add_box(vase, "Vase", vec3(-10, 0, -10), vec3(10, 40, 30), false);
  add_point_light(vase, "Candle", {0, 50, 0}, 5);
  vase.root["asset"]["copyright"] = "2020 Somebody";
  vase.root["asset"]["extras"] = {{"title", "A vase"},
                                  {"author", "Somebody"},
                                  {"license", "CC-BY"},
                                  {"source", "https://example.org"},
                                  {"number", 7}};
  package.write("vase.gltf", vase.gltf());
  package.manifest.erase("scene");
  package.manifest["scenes"] = {
      {{"file", "scene.gltf"}},
      {{"file", "vase.gltf"}, {"position", {0, 0.8, -0.5}}, {"yaw_deg", 90}, {"scale", 0.01}}};
  package.manifest["objects"] = {{"vase", {{"node", "Vase"}}}, {"table", {{"node", "Table"}}}};
  package.manifest["lamps"] =
      nlohmann::json::array({{{"id", "l"}, {"title", {{"en", "L"}}}, {"nodes", {"Lamp"}}},
                             {{"id", "c"}, {"title", {{"en", "C"}}}, {"nodes", {"Candle"}}}});
  Exhibit exhibit = package.read();
  EXPECT_EQ(package.told(), "");
  ASSERT_EQ(exhibit.points.size(), 2u);
  // Its middle (0, 0.2, 0.1) turned left by 90 degrees: +z becomes +x.
  const dvec3 vase_place = find_point(exhibit, "vase")->place;
  EXPECT_LT(glm::length(vase_place - dvec3(0.1, 1.0, -0.5)), 1e-5);
  EXPECT_LT(glm::length(find_point(exhibit, "table")->place - dvec3(0, 0.4, -0.5)), 1e-5);
  ASSERT_EQ(exhibit.scene.lights.size(), 2u);
  EXPECT_LT(glm::length(exhibit.scene.lights[1].position - vec3(0, 1.3f, -0.5f)), 1e-5f);
  EXPECT_NEAR(exhibit.scene.lights[1].intensity.x, 5e-4, 1e-9) << "as bright on the vase as ever";
  EXPECT_EQ(exhibit.scene.lamps.at(1).lights, (std::vector<int>{1}));
  for (const Instance& instance : exhibit.scene.instances)
    EXPECT_LT(size_t(exhibit.scene.meshes[size_t(instance.mesh)].material),
              exhibit.scene.materials.size());
  ASSERT_EQ(exhibit.credits.size(), 1u);
  EXPECT_EQ(exhibit.credits[0].file, "vase.gltf");
  EXPECT_EQ(exhibit.credits[0].author, "Somebody");
  EXPECT_EQ(exhibit.credits[0].licence, "CC-BY");
  EXPECT_EQ(exhibit.credits[0].copyright, "2020 Somebody");
}

TEST(ExhibitFiles, MistakesHaveAPlace) {
  RoomPackage package;
  package.manifest["scenes"] = {{{"file", "scene.gltf"}}};
  package.read();
  EXPECT_EQ(package.says("/scene", "one of them only"), 1) << package.told();
  package.manifest["scene"] = "sceen.gltf";
  package.manifest.erase("scenes");
  package.read();
  EXPECT_EQ(package.says("/scene", "did you mean 'scene.gltf'?"), 1) << package.told();
  package.manifest.erase("scene");
  package.manifest["scenes"] = {{{"file", "none.gltf"}, {"scale", 0}, {"at", 1}}};
  package.read();
  EXPECT_EQ(package.says("/scenes/0/file", "no file"), 1) << package.told();
  EXPECT_EQ(package.says("/scenes/0/scale", "must be a number from"), 1) << package.told();
  EXPECT_EQ(package.says("/scenes/0/at", "ignored"), 1) << package.told();
  package.manifest["scenes"] = nlohmann::json::array();
  package.read();
  EXPECT_EQ(package.says("/scenes", "at least one"), 1) << package.told();
}

TEST(ExhibitFiles, ViewpointsMayLean) {
  RoomPackage package;
  package.manifest["viewpoints"][0]["roll_deg"] = -30;
  EXPECT_NEAR(package.read().viewpoints[0].view.roll, -pi / 6, 1e-6f);
  package.manifest["viewpoints"][0]["roll_deg"] = 181;
  package.read();
  EXPECT_EQ(package.says("/viewpoints/0/roll_deg", "must be a number from"), 1) << package.told();
}

TEST(ExhibitFiles, ScaleIsOfTheWholeScene) {
  RoomPackage package;
  package.manifest["scale"] = 0.5;
  Exhibit exhibit = package.read();
  Bounds box = scene_bounds(exhibit.scene);
  EXPECT_LT(glm::length(box.high - vec3(2, 1.5f, 1.5f)), 1e-5f);
  EXPECT_EQ(exhibit.scene.lights.at(0).intensity, vec3(2));
}
