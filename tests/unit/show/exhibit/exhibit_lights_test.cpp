// SPDX-License-Identifier: Apache-2.0
// `lights` of exhibit.json: what they become, and every mistake with its place.
#include "show/exhibit/exhibit_lights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "unit/show/exhibit/room_package.h"

namespace wellspring::test {
namespace {

using test::RoomPackage;

Asset two_lamps() {
  Asset asset = test::room_asset();
  test::add_point_light(asset, "Fire", {2, 0.5f, 0}, 3);
  return asset;
}

struct LightsPackage : RoomPackage {
  explicit LightsPackage(const std::string& lights) : RoomPackage(two_lamps()) {
    manifest["lamps"] = json::parse(R"([{"id": "hearth", "title": "Hearth", "nodes": ["Fire"]},
                                        {"id": "room", "title": "Room", "nodes": ["Lamp"]}])");
    manifest["lights"] = json::parse(lights);
  }
};

TEST(ExhibitLights, ALightOfTheSceneIsTakenOutAndKeepsItsLamp) {
  LightsPackage package(R"([{"node": "Lamp", "flicker": {"depth": 0.2, "hz": 3}}])");
  EXPECT_EQ(package.read().scene.lights.size(), 2u) << "a check sees the whole scene";
  EXPECT_EQ(package.told(), "");
  const Exhibit exhibit = load_exhibit(package.folder.file("room"));
  ASSERT_EQ(exhibit.lights.size(), 1u);
  const ChangingLight& light = exhibit.lights[0];
  EXPECT_EQ(light.name, "Lamp");
  EXPECT_EQ(light.lamp, 1);
  EXPECT_EQ(light.light.intensity, vec3(8));
  EXPECT_EQ(light.flicker.depth, 0.2f);
  EXPECT_EQ(light.flicker.hz, 3);
  EXPECT_EQ(exhibit.scene.dynamic_lights, 1) << "the transport plan tells of it";
  ASSERT_EQ(exhibit.scene.lights.size(), 1u);
  EXPECT_EQ(exhibit.scene.lights[0].name, "Fire");
  EXPECT_EQ(exhibit.scene.lamps[0].lights, std::vector<int>{0}) << "it has moved up";
  EXPECT_TRUE(exhibit.scene.lamps[1].lights.empty());
}

TEST(ExhibitLights, AreBackInAPictureOfOneMoment) {
  LightsPackage package(R"([{"node": "Lamp", "flicker": {"depth": 0.5}}])");
  package.read();
  const Exhibit exhibit = load_exhibit(package.folder.file("room"));
  Scene scene = exhibit.scene;
  put_lights(exhibit.lights, 1.25, scene);
  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_EQ(scene.lights[1].intensity, eval_light(exhibit.lights[0], 1.25).intensity);
  EXPECT_NE(scene.lights[1].intensity, vec3(8));
  EXPECT_EQ(scene.lamps[1].lights, std::vector<int>{1});
}

TEST(ExhibitLights, NewOnesAreMadeAndMove) {
  LightsPackage package(R"([
    {"name": "Moth", "type": "spot", "position": [1, 2, 0], "direction": [0, -2, 0], "candela": 4,
     "color": [1, 0.5, 0.25], "reach": 6, "outer_cone_deg": 30, "inner_cone_deg": 10,
     "lamp": "hearth",
     "track": [{"time": 0}, {"time": 2, "position": [1, 2, 1], "intensity": 0.5},
               {"time": 4, "position": [1, 2, 0], "intensity": 1}]},
    {"name": "Moon", "type": "sun", "direction": [0, -1, 0], "lux": 2, "flicker": {}}])");
  package.manifest["scale"] = 2;  // the scene's; other places are metres
  const Exhibit exhibit = package.read();
  EXPECT_EQ(package.told(), "");
  ASSERT_EQ(exhibit.lights.size(), 2u);
  const ChangingLight& moth = exhibit.lights[0];
  EXPECT_EQ(moth.light.type, PunctualType::spot);
  EXPECT_EQ(moth.light.intensity, vec3(4, 2, 1));
  EXPECT_LT(glm::length(moth.light.direction - vec3(0, -1, 0)), 1e-6f);
  EXPECT_NEAR(moth.light.outer_cone, pi / 6, 1e-5);
  EXPECT_NEAR(moth.light.inner_cone, pi / 18, 1e-5);
  EXPECT_EQ(moth.light.range, 6);
  EXPECT_TRUE(std::isinf(exhibit.lights[1].light.range));
  EXPECT_EQ(moth.lamp, 0);
  EXPECT_EQ(vec3(exhibit.scene.origin) + moth.track[1].position, vec3(1, 2, 1));
  EXPECT_EQ(moth.track[0].position, moth.light.position);
  EXPECT_EQ(moth.track[1].intensity, 0.5f);
  EXPECT_EQ(exhibit.lights[1].light.type, PunctualType::directional);
  EXPECT_EQ(exhibit.lights[1].lamp, -1);
  EXPECT_GT(exhibit.lights[1].flicker.depth, 0);
}

TEST(ExhibitLights, EveryProblemIsToldWithItsPlace) {
  LightsPackage package(R"([
    {"node": "Fires", "flicker": {}},
    {"node": "Table", "flicker": {}},
    {"node": "Fire"},
    {"node": "Fire", "flicker": {"depth": 2, "hz": 9}},
    {"type": "point", "name": "A", "position": [0, 1], "candela": -1, "lamp": "moon", "flicker": {}},
    {"type": "glow", "name": "B", "position": [0, 1, 0], "candela": 1, "flicker": {}},
    {"type": "sun", "name": "B", "node": "Lamp", "direction": [0, 0, 0], "lux": 1, "flicker": {}},
    {"type": "spot", "name": "C", "position": [0, 1, 0], "direction": [1, 0, 0], "candela": 1,
     "inner_cone_deg": 50, "flicker": {"depth": 0.1},
     "track": [{"time": 1}, {"time": 1.1, "direction": [-1, 0, 0.1], "intensity": 2}]},
    {"type": "point", "name": "D", "position": [0, 1, 0], "candela": 1, "track": [{"time": 0}]},
    {"type": "point", "name": "E", "position": [0, 1, 0], "candela": 1, "speed": 2,
     "track": [{"time": 0}, {"time": 1, "position": [1, 1, 0]}]},
    {"type": "point", "flicker": {}}])");
  package.read();
  const std::pair<const char*, const char*> expected[] = {
      {"/lights/0/node", "did you mean 'Fire'"},
      {"/lights/1/node", "is a point, spot or distant light"},
      {"/lights/2", "neither"},
      {"/lights/3/node", "another entry's"},
      {"/lights/3/flicker/depth", "from 0 to 1"},
      {"/lights/3/flicker/hz", "from 0.1 to 5"},
      {"/lights/4/position", "three numbers"},
      {"/lights/4/candela", "from 0"},
      {"/lights/4/lamp", "no lamp 'moon'"},
      {"/lights/5/type", "one of point, spot, sun"},
      {"/lights/6/node", "beside a \"type\""},
      {"/lights/6/name", "taken"},
      {"/lights/6/direction", "zero"},
      {"/lights/7/inner_cone_deg", "wider"},
      {"/lights/7/track/0/time", "must be 0"},
      {"/lights/7/track/1/time", "0.2 s"},
      {"/lights/7/track/1/direction", "120 degrees"},
      {"/lights/7/track", "jump"},
      {"/lights/7/flicker", "one of them"},
      {"/lights/8/track", "at least two"},
      {"/lights/9/track", "jump"},
      {"/lights/9/speed", "ignored"},
      {"/lights/10/name", "missing"},
      {"/lights/10/position", "missing"},
      {"/lights/10/candela", "missing"}};
  for (const auto& [where, what] : expected)
    EXPECT_EQ(package.says(where, what), 1) << where << ": " << what << "\n" << package.told();
  EXPECT_EQ(package.problems.size(), std::size(expected)) << package.told();
}

TEST(ExhibitLights, ThereAreAFewAtMost) {
  json many = json::array();
  for (size_t i = 0; i <= most_changing_lights; i++)
    many.push_back({{"type", "point"},
                    {"name", "L" + std::to_string(i)},
                    {"position", {0, 1, 0}},
                    {"candela", 1},
                    {"flicker", json::object()}});
  LightsPackage package(many.dump());
  package.read();
  EXPECT_EQ(package.says("/lights", "at most 16"), 1) << package.told();
}

struct DayPackage : RoomPackage {
  explicit DayPackage(const std::string& day) : RoomPackage(with_sun()) {
    manifest["lamps"] = json::parse(
        R"([{"id": "day", "title": "Day", "nodes": ["Sun", "Fire"]},
            {"id": "room", "title": "Room", "nodes": ["Lamp", "Other Sun"]}])");
    manifest["day"] = json::parse(day);
  }
  static Asset with_sun() {
    Asset asset = two_lamps();
    json& lights = asset.root["extensions"]["KHR_lights_punctual"]["lights"];
    // 45 degrees up, and lying down.
    for (auto [name, x] : {std::pair("Sun", -0.3826834f), std::pair("Other Sun", 0.0f)}) {
      lights.push_back({{"type", "directional"}, {"intensity", 10}});
      asset.add_node({{"name", name},
                      {"rotation", {x, 0, 0, std::sqrt(1 - x * x)}},
                      {"extensions", {{"KHR_lights_punctual", {{"light", lights.size() - 1}}}}}});
    }
    return asset;
  }
};

TEST(ExhibitDay, SunAndSkyArePartedAndOneSwitchIsLeft) {
  DayPackage package(R"({"lamp": "day", "sun": "Sun", "at": 11.5, "latitude_deg": 48, "from": 6})");
  const Exhibit exhibit = package.read();
  EXPECT_EQ(package.told(), "");
  ASSERT_TRUE(exhibit.day);
  EXPECT_EQ(exhibit.day->settings.at, 11.5);
  EXPECT_EQ(exhibit.day->settings.from, 6);
  EXPECT_EQ(exhibit.day->settings.to, 22);
  EXPECT_EQ(exhibit.lamps.size(), 2u);
  ASSERT_EQ(exhibit.scene.lamps.size(), 3u);
  EXPECT_EQ(exhibit.day->lamp, 0);
  EXPECT_EQ(exhibit.day->sun_lamp, 2);
  EXPECT_EQ(exhibit.scene.lamps[0].lights, std::vector<int>{1});
  EXPECT_EQ(exhibit.scene.lamps[2].lights, std::vector<int>{2});
  EXPECT_EQ(first_levels(exhibit), LampLevels(3, lamp_full));
  Scene scene = exhibit.scene;
  put_sun(*exhibit.day, 17, scene);
  EXPECT_EQ(scene.lights[2].direction, eval_sun(*exhibit.day, 17).direction);
}

TEST(ExhibitDay, EveryProblemIsToldWithItsPlace) {
  const std::tuple<const char*, const char*, const char*> cases[] = {
      {R"({"lamp": "night", "sun": "Sun", "at": 12})", "/day/lamp", "no lamp 'night'"},
      {R"({"lamp": "day", "sun": "Son", "at": 12})", "/day/sun", "did you mean 'Sun'"},
      {R"({"lamp": "day", "sun": "Fire", "at": 12})", "/day/sun", "is no sun"},
      {R"({"lamp": "day", "sun": "Other Sun", "at": 12})", "/day/sun", "the lamp 'room'"},
      {R"({"lamp": "room", "sun": "Other Sun", "at": 12})", "/day", "10 at least"},
      {R"({"lamp": "day", "sun": "Sun", "at": 6})", "/day", "at the hour 6"},
      {R"({"lamp": "day", "sun": "Sun", "at": 4})", "/day/at", "between"},
      {R"({"lamp": "day", "sun": "Sun", "at": 12, "from": 12, "to": 11})", "/day/to", "later"},
      {R"({"lamp": "day", "sun": "Sun", "at": 25})", "/day/at", "from 0 to 24"},
      {R"({"lamp": "day", "sun": "Sun", "at": 12, "latitude_deg": 80})", "/day/latitude_deg", "66"},
      {R"({"lamp": "day", "sun": "Sun"})", "/day/at", "missing"},
      {R"({"lamp": "day", "sun": "Sun", "at": 12, "noon": 1})", "/day/noon", "ignored"}};
  for (const auto& [day, where, what] : cases) {
    DayPackage package(day);
    package.read();
    EXPECT_EQ(package.says(where, what), 1) << day << "\n" << package.told();
  }
  DayPackage twice(R"({"lamp": "day", "sun": "Sun", "at": 12})");
  twice.manifest["lights"] = json::parse(R"([{"node": "Sun", "flicker": {}}])");
  twice.read();
  EXPECT_EQ(twice.says("/day/sun", "\"lights\" already"), 1) << twice.told();
}

}  // namespace
}  // namespace wellspring::test
