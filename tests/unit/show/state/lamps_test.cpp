// SPDX-License-Identifier: Apache-2.0
// Lamps of a running exhibit: switched by visitors, for themselves or for all of them.
#include "show/state/lamps.h"

#include <gtest/gtest.h>

#include <algorithm>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "show/exhibit/exhibit_lights.h"
#include "show/exhibit/load/exhibit_load.h"
#include "show/http/answer.h"
#include "show/state/in_view.h"
#include "show/state/visitor_picture.h"
#include "spectrum/lamps.h"
#include "unit/show/show_stage.h"
#include "world/load/lamp.h"
#include "world/load/scene_spectra.h"

namespace wellspring::test {
namespace {

using nlohmann::json;

// The tiny room's lamp can be switched, and so can a weak one that stands in its corner.
Exhibit make_lit_exhibit(bool on_at_first = true) {
  Exhibit exhibit = make_tiny_exhibit();
  PunctualLight weak;
  weak.name = "weak";
  weak.position = {3, 2, -3};
  weak.intensity = vec3(0.5f);
  exhibit.scene.lights.push_back(weak);
  add_lamp({"ceiling", {"light"}, {}}, exhibit.scene);
  exhibit.lamps = {{"ceiling", {{"en", "Ceiling"}, {"de", "Decke"}}, on_at_first, true}};
  return exhibit;
}

struct Lamps : testing::Test, ShowStage {
  void begin(Exhibit exhibit, int visitors, const std::string& technique = "gather") {
    ShowStage::begin(std::move(exhibit), settings_for(technique, 50));
    for (int i = 0; i < visitors; i++) join(96, 64, i ? "de" : "en", i ? "kiosk" : "visitor");
  }
  void lamp(size_t visitor, const char* name, bool on) {
    say(json{{"type", "lamp"}, {"name", name}, {"on", on}}.dump(), visitor);
  }
  double level(size_t visitor) {
    Image8 shown = last_image(visitor);
    double sum = 0;
    for (uint8_t value : shown.rgb) sum += value;
    return sum / double(shown.rgb.size());
  }
};

TEST_F(Lamps, OneSwitchesAndAllAreToldAndSeeIt) {
  begin(make_lit_exhibit(), 2);
  run(1.5);
  EXPECT_EQ(last("welcome")["lamps"],
            json::parse(R"([{"name":"ceiling","title":"Ceiling","on":true,"shared":true}])"));
  EXPECT_EQ(last("welcome", 1)["lamps"][0]["title"], "Decke");
  double lit[2] = {level(0), level(1)};
  lamp(1, "ceiling", false);
  step();
  step();
  for (size_t i : {0, 1})
    EXPECT_EQ(last("state", i)["lamps"], json::parse(R"({"ceiling":false})")) << i;
  run(0.5);
  double dark[2] = {level(0), level(1)};
  for (size_t i : {0, 1}) EXPECT_LT(dark[i], 0.6 * lit[i]) << i;
  lamp(0, "ceiling", true);
  run(1);
  for (size_t i : {0, 1}) EXPECT_NEAR(level(i) / lit[i], 1, 0.05) << i;
  EXPECT_EQ(make_report(*show).totals.lamps_switched, 2u);
}

// A visitor turns the dial: the picture has the other light's colour, and everybody is told.
TEST_F(Lamps, ADialSetsAnotherLight) {
  Exhibit exhibit = make_lit_exhibit();
  Scene& scene = exhibit.scene;
  set_lamp_spectrum(scene, scene.lamps[0],
                    add_spectrum(scene, "D65", spectrum::find_lamp("D65")->power));
  const Spectrum candle = spectrum::find_lamp("candle")->power;
  scene.lamps[0].dial.push_back({add_spectrum(scene, "candle", candle), lamp_color(candle)});
  exhibit.lamps[0].spectrum = "D65";
  exhibit.lamps[0].dial = {{"candle", {{"en", "Candle"}}}};
  begin(std::move(exhibit), 2);
  run(1.5);
  EXPECT_EQ(last("welcome")["lamps"][0]["dial"],
            json::parse(R"([{"light":"candle","title":"Candle"}])"));
  EXPECT_EQ(last("welcome")["lamps"][0]["light"], "D65");
  auto warmth = [&] {
    const Image8 shown = last_image(0);
    double sum[3] = {1, 1, 1};
    for (size_t i = 0; i < shown.rgb.size(); i++) sum[i % 3] += shown.rgb[i];
    return sum[0] / sum[2];
  };
  const double day = warmth();
  say(R"({"type":"lamp","name":"ceiling","on":true,"light":"moon"})", 1);
  step();
  EXPECT_EQ(last("error", 1)["code"], "unknown_light");
  say(R"({"type":"lamp","name":"ceiling","on":true,"light":"candle"})", 1);
  run(1.5);
  for (size_t i : {0, 1}) EXPECT_EQ(last("state", i)["lights"]["ceiling"], "candle") << i;
  EXPECT_GT(warmth(), 1.3 * day);
  EXPECT_EQ(show->stage.world->lamp_levels()[0], LampLevel(lamp_full, 1));
  say(R"({"type":"lamp","name":"ceiling","on":true,"light":"D65"})", 1);
  run(1.5);
  EXPECT_NEAR(warmth() / day, 1, 0.05);
}

// The change of light is computed once for all caches that knew the same lamps, and kept until the
// last of them has followed.
TEST_F(Lamps, VisitorsShareWhatBecomesOfTheLight) {
  Exhibit exhibit = make_lit_exhibit();
  add_lamp({"corner", {"weak"}, {}}, exhibit.scene);
  exhibit.lamps.push_back({"corner", {{"en", "Corner"}}, true, true});
  begin(std::move(exhibit), 4);
  run(1);
  lamp(0, "ceiling", false);
  std::vector<LightStep>& steps = show->stage.switches.steps;
  ASSERT_TRUE(steps.empty());
  ASSERT_TRUE(step_until([&] { return !steps.empty(); }, 50));
  const LampLevels lit{0, lamp_full};
  auto follows = [&](const Visitor& visitor) { return visitor.picture->lamps == lit; };
  EXPECT_FALSE(
      std::ranges::all_of(show->visits.visitors, follows));  // one is drawn after the other
  ASSERT_TRUE(step_until([&] { return steps.size() != 1; }, 200));
  EXPECT_TRUE(steps.empty());
  EXPECT_TRUE(std::ranges::all_of(show->visits.visitors, follows));

  // A visitor who has missed a switch before has another change to follow.
  constexpr LampLevel full = lamp_full;
  const LampLevels known[] = {{full, full}, {full, 0}, {full, full}, {full, 0}};
  size_t i = 0;
  for (Visitor& visitor : show->visits.visitors) visitor.picture->lamps = known[i++];
  for (Visitor& visitor : show->visits.visitors) follow_lamps(show->stage, visitor);
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_EQ(steps[0].before, known[0]);
  EXPECT_EQ(steps[1].before, known[1]);
  show->visits.visitors.front().picture->lamps = known[1];  // as if it had yet to follow
  forget_lights(show->stage, show->visits);
  ASSERT_EQ(steps.size(), 1u);
  EXPECT_EQ(steps[0].before, known[1]);
}

// Each sees the room in their own light, in one world that is lit for one after the other.
TEST_F(Lamps, WhatIsNotSharedIsSwitchedForOneselfAlone) {
  Exhibit exhibit = make_lit_exhibit();
  exhibit.lamps[0].shared = false;
  begin(std::move(exhibit), 3);
  run(1.5);
  EXPECT_EQ(last("welcome")["lamps"][0]["shared"], false);
  double lit[3] = {level(0), level(1), level(2)};
  lamp(1, "ceiling", false);
  run(1);
  EXPECT_EQ(last("state", 0)["lamps"]["ceiling"], true);
  EXPECT_EQ(last("state", 1)["lamps"]["ceiling"], false);
  EXPECT_LT(level(1), 0.6 * lit[1]);
  for (size_t i : {0, 2}) EXPECT_NEAR(level(i) / lit[i], 1, 0.05) << i;
  EXPECT_EQ(show->stage.switches.others.size(), 1u);
  lamp(2, "ceiling", false);
  lamp(1, "ceiling", true);
  run(1);
  EXPECT_LT(level(2), 0.6 * lit[2]);
  for (size_t i : {0, 1}) EXPECT_NEAR(level(i) / lit[i], 1, 0.05) << i;
  lamp(2, "ceiling", true);
  run(1);
  EXPECT_TRUE(show->stage.switches.others.empty()) << "nobody sees it any more";
  EXPECT_TRUE(show->stage.switches.steps.empty());
}

TEST_F(Lamps, UnknownOnesAreRefusedAndNothingChanges) {
  begin(make_lit_exhibit(), 1, "path");
  run(0.1);
  lamp(0, "moon", false);
  run(0.1);
  EXPECT_EQ(last("error")["code"], "unknown_lamp");
  EXPECT_EQ(show->stage.world->lamp_levels()[0], lamp_full);
  lamp(0, "ceiling", true);  // it is
  run(0.1);
  EXPECT_EQ(show->totals.lamps_switched, 0u);
}

TEST_F(Lamps, WhatIsOffAtFirstIsOffForStillsAndForWhoComes) {
  begin(make_lit_exhibit(false), 1, "path");
  run(0.2);
  EXPECT_EQ(last("welcome")["lamps"][0]["on"], false);
  EXPECT_EQ(show->stage.world->lamp_levels()[0], 0);
  run(0.5);
  double dark = level(0);
  lamp(0, "ceiling", true);
  run(0.6);
  EXPECT_GT(level(0), 1.5 * dark);
}

// Nobody makes it flash: within a second the light changes five times at most, and ends as was
// asked for last.
TEST_F(Lamps, TheLightChangesAFewTimesASecondAtMost) {
  begin(make_lit_exhibit(), 1, "direct");
  run(1);
  int changes = 0;
  for (int i = 0; i < 50; i++) {
    const LampLevel before = show->stage.world->lamp_levels()[0];
    lamp(0, "ceiling", i % 2 == 1);
    step();
    changes += before != show->stage.world->lamp_levels()[0];
  }
  EXPECT_LE(changes, 6);
  EXPECT_GE(changes, 1);
  run(0.4);
  EXPECT_EQ(show->stage.world->lamp_levels()[0], lamp_full);
}

// Requests of the old light are out, and some are answered, when the lamp is switched.
TEST_F(Lamps, AnswersOfTheOldLightAreNotTaken) {
  begin(make_lit_exhibit(), 1, "path");
  run(0.5);
  Visitor& visitor = show->visits.visitors.front();
  View view = view_of(*show, visitor);
  std::vector<Request> requests(64);
  for (size_t i = 0; i < requests.size(); i++) requests[i] = pixel_request(view, 5, int(i), 20, 0);
  visitor.picture->broker.ask(view, {show->stage.technique, show->settings.transport}, requests);
  std::optional<cache::Piece> piece = visitor.picture->broker.take();
  ASSERT_TRUE(piece);
  Answer old{*piece, show->cast.pose_number, std::vector<Sample>(piece->requests.size())};
  lamp(0, "ceiling", false);
  run(0.2);
  EXPECT_EQ(visitor.picture->lamps, LampLevels{0});
  EXPECT_FALSE(visitor.picture->broker.answer(old));
  EXPECT_TRUE(visitor.picture->broker.collect().empty());
}

struct Package {
  std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("wellspring_lamps_" + std::to_string(getpid()));
  json manifest;
  Package() {
    std::filesystem::create_directories(folder / "room");
    json scene = json::parse(R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_lights_punctual"],
      "extensions":{"KHR_lights_punctual":{"lights":[{"type":"point"},{"type":"directional"}]}},
      "nodes":[{"name":"Bulb","extensions":{"KHR_lights_punctual":{"light":0}}},
               {"name":"Sun","extensions":{"KHR_lights_punctual":{"light":1}}},{"name":"Eye","camera":0}],
      "cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":0.1}}],"scenes":[{"nodes":[0,1,2]}]})");
    std::ofstream(folder / "room" / "scene.gltf") << scene.dump();
    manifest = {{"title", "Room"}, {"languages", {"en", "de"}}, {"scene", "scene.gltf"}};
  }
  ~Package() { std::filesystem::remove_all(folder); }
  std::vector<Problem> problems;
  Exhibit read(const json& lamps) {
    manifest["lamps"] = lamps;
    std::ofstream(folder / "room" / "exhibit.json") << manifest.dump();
    problems.clear();
    return read_exhibit((folder / "room").string(), problems);
  }
  bool says(const std::string& where, const std::string& what, bool fatal = true) {
    for (const Problem& problem : problems)
      if (problem.where == where && problem.what.find(what) != std::string::npos &&
          problem.fatal == fatal)
        return true;
    return false;
  }
};

TEST(ExhibitLamps, AreReadWithTitlesAndFirstStates) {
  Package package;
  Exhibit exhibit = package.read(
      json::parse(R"([{"id":"bulb","title":{"en":"Bulb","de":"Birne"},"nodes":["Bulb"],"on":false},
                                                 {"id":"sun","title":{"en":"Sun","de":"Sonne"},"nodes":["Sun"]}])"));
  for (const Problem& problem : package.problems) EXPECT_FALSE(problem.fatal) << to_string(problem);
  ASSERT_EQ(exhibit.lamps.size(), 2u);
  EXPECT_EQ(first_lamps(exhibit), (std::vector<LampSwitch>{0, 1}));
  EXPECT_EQ(exhibit.lamps[1].title.at("de"), "Sonne");
  EXPECT_EQ(exhibit.scene.lamps[1].lights, (std::vector<int>{1}));
}

TEST(ExhibitLamps, EveryProblemIsToldWithItsPlace) {
  Package package;
  package.read(json::parse(R"([{"id":"a","title":{"en":"A"},"nodes":["Moon","Bulb"]},
                               {"id":"a","title":{"en":"A","de":"A"},"nodes":["Sun"]},
                               {"id":"c","nodes":["Bulb"],"materials":["wax"],"on":"yes"},
                               {"id":"d","title":{"en":"D","de":"D"}, "lights":["Sun"]},
                               {"title":{"en":"E","de":"E"},"nodes":"Sun"}])"));
  EXPECT_TRUE(package.says("/lamps/0/nodes/0", "no node 'Moon'"));
  EXPECT_TRUE(package.says("/lamps/0/title", "'de'", false));
  EXPECT_TRUE(package.says("/lamps/1/id", "taken"));
  EXPECT_TRUE(package.says("/lamps/2/title", ""));
  EXPECT_TRUE(package.says("/lamps/2/nodes/0", "the lamp 'a'"));
  EXPECT_TRUE(package.says("/lamps/2/materials/0", "no material 'wax'"));
  EXPECT_TRUE(package.says("/lamps/2/on", "true or false"));
  EXPECT_TRUE(package.says("/lamps/3", "neither"));
  EXPECT_TRUE(package.says("/lamps/3/lights", "ignored", false));
  EXPECT_TRUE(package.says("/lamps/4/id", ""));
  EXPECT_TRUE(package.says("/lamps/4/nodes", "list"));
  json many = json::array();
  for (int i = 0; i <= int(most_lamps); i++)
    many.push_back({{"id", "l" + std::to_string(i)}, {"title", "L"}, {"nodes", {"Bulb"}}});
  package.read(many);
  EXPECT_TRUE(package.says("/lamps", "at most 32"));
}

}  // namespace
}  // namespace wellspring::test
