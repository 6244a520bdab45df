// SPDX-License-Identifier: Apache-2.0
// What a package says of things to hold, right and wrong.
#include <gtest/gtest.h>

#include <fstream>

#include "show/exhibit/exhibit_objects.h"
#include "unit/avatar/figures.h"
#include "unit/show/exhibit/room_package.h"

namespace wellspring::test {
namespace {

Asset lantern(vec3 low = {-0.05f, 0, -0.05f}, vec3 high = {0.05f, 0.4f, 0.05f}) {
  Asset asset;
  add_box(asset, "Box", low, high, false);
  add_point_light(asset, "Flame", {0, 0.5f, 0}, 7);
  return asset;
}

struct PropsTest : testing::Test {
  RoomPackage package;
  void SetUp() override {
    package.write("lantern.gltf", lantern().gltf());
    package.manifest["props"] = {{{"id", "lantern"}, {"file", "lantern.gltf"}}};
  }
  json& prop() { return package.manifest["props"][0]; }
  void add_story(const std::string& text) {
    package.manifest["stories"] = {
        {{"id", "s"}, {"title", {{"en", "S"}}}, {"text", {{"en", {text}}}}}};
  }
};

TEST_F(PropsTest, APropIsReadWithItsLight) {
  prop().update({{"hand", "left"},
                 {"flicker", {{"depth", 0.5}}},
                 {"grip", {{"position", {0, 0.1, 0}}, {"turn_deg", {0, 0, 90}}}}});
  add_story("Look, <hold name='lantern'/>here it is.<hold name='nothing'/>");
  Exhibit exhibit = package.read();
  EXPECT_EQ(package.told().find("lantern"), std::string::npos) << package.told();
  ASSERT_EQ(exhibit.props.size(), 1u);
  const ExhibitProp& lantern = exhibit.props[0];
  EXPECT_EQ(lantern.side, 0);
  EXPECT_EQ(lantern.gesture, "hold_up");
  EXPECT_EQ(lantern.flicker.depth, 0.5f);
  ASSERT_EQ(lantern.scene.lights.size(), 1u);
  const vec3 light(lantern.to_fist * vec4(lantern.scene.lights[0].position, 1));
  EXPECT_LT(glm::length(light - vec3(-0.4f, 0, 0)), 1e-5f) << "0.4 m above the grip, then turned";
  ASSERT_EQ(exhibit.stories.size(), 1u);
  const std::vector<StoryMark>& marks = exhibit.stories[0].text["en"][0].marks;
  ASSERT_EQ(marks.size(), 2u);
  EXPECT_EQ(marks[0].kind, StoryMarkKind::hold);
  EXPECT_EQ(marks[0].name, "lantern");
  EXPECT_EQ(marks[1].name, "");
}

TEST_F(PropsTest, WhatIsWrongIsNamedWithItsPlace) {
  auto file = [&] { return package.folder.file("room") + "/exhibit.json"; };
  prop()["hand"] = "third";
  prop()["flicker"] = {{"depth", 2}};
  prop()["grib"] = 1;
  prop()["file"] = "missing.glb";
  package.read();
  EXPECT_EQ(package.says("/props/0/hand", "one of left, right"), 1) << package.told();
  EXPECT_EQ(package.says("/props/0/flicker/depth", "1"), 1) << package.told();
  EXPECT_EQ(package.says("/props/0/file", "missing.glb"), 1) << package.told();
  EXPECT_NE(package.told().find("grib"), std::string::npos);
  EXPECT_NE(package.told().find(file()), std::string::npos);
  prop() = {{"id", "nothing"}, {"file", "lantern.gltf"}};
  package.manifest["props"].push_back(prop());
  package.read();
  EXPECT_EQ(package.says("/props/0/id", "free hand"), 1) << package.told();
  EXPECT_EQ(package.says("/props/1/id", "taken by another"), 1) << package.told();
  package.manifest["props"] = json::array({prop()});
  prop() = {{"id", "lantern"}, {"file", "lantern.gltf"}};
  package.write("lantern.gltf", "{\"asset\": 3}");
  package.read();
  EXPECT_NE(package.told().find("lantern.gltf"), std::string::npos);
}

TEST_F(PropsTest, TheGestureMustBeOneThatHolds) {
  std::ifstream figure(std::string(WELLSPRING_SOURCE) + "/content/castle/figures/storyteller.x3d");
  package.write("figure.x3d", {std::istreambuf_iterator<char>(figure), {}});
  package.manifest["storyteller"] = {
      {"figure", "figure.x3d"}, {"position", {0, 0, 1}}, {"name", {{"en", "Anna"}}}};
  package.read();
  EXPECT_EQ(package.told().find("/props"), std::string::npos) << package.told();
  prop()["gesture"] = "hold_upp";
  package.read();
  EXPECT_EQ(package.says("/props/0/gesture", "did you mean 'hold_up'?"), 1) << package.told();
  prop()["gesture"] = "nod";
  package.read();
  EXPECT_EQ(package.says("/props/0/gesture", "can hold nothing"), 1) << package.told();
  prop().erase("gesture");
  package.write("figure.x3d", small_skin());
  package.read();
  EXPECT_EQ(package.says("/props/0/hand", "has no right hand"), 1) << package.told();
}

TEST_F(PropsTest, AStoryWithAnUnknownPropIsToldWithItsPlace) {
  add_story("Look, <hold name='lantrn'/>here it is.");
  package.read();
  EXPECT_EQ(package.says("line 1, column 7", "there is no prop 'lantrn'; did you mean 'lantern'?"),
            1)
      << package.told();
}

TEST_F(PropsTest, WhatIsTooMuchForAHandIsRefused) {
  auto refused = [&](const Asset& asset, const std::string& why) {
    package.write("lantern.gltf", asset.gltf());
    package.read();
    EXPECT_EQ(package.says("/props/0/file", why), 1) << package.told();
  };
  refused(lantern({-0.05f, 0, -0.05f}, {0.05f, 40, 0.05f}), "reaches 40 m");
  Asset many;
  for (size_t i = 0; i * 12 <= most_prop_triangles; i++)
    add_box(many, "Box", {-0.05f, 0, -0.05f}, {0.05f, 0.4f, 0.05f}, false);
  refused(many, "triangles");
  Asset bright = lantern();
  for (size_t i = 0; i < most_prop_lights; i++) add_point_light(bright, "More", {0, 0, 0}, 1);
  refused(bright, "5 lights");
  Asset sun = lantern();
  sun.root["extensions"]["KHR_lights_punctual"]["lights"][0]["type"] = "directional";
  refused(sun, "directional");
  Asset empty;
  add_point_light(empty, "Light", {0, 0, 0}, 1);
  refused(empty, "nothing to hold");
}

}  // namespace
}  // namespace wellspring::test
