// SPDX-License-Identifier: Apache-2.0
// The hour of the day, which visitors choose for themselves.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "show/state/lamps.h"
#include "unit/folder.h"
#include "unit/show/show_stage.h"

namespace wellspring::test {
namespace {

using nlohmann::json;

struct Hour : testing::Test, ShowStage {
  test::Folder folder;
  void begin(int visitors, const std::string& technique = "direct") {
    browsers.clear();
    Exhibit exhibit = make_tiny_exhibit();
    add_day(exhibit);
    ShowSettings settings = settings_for(technique, 50);
    settings.cache = folder.path;
    settings.bakes = false;
    ShowStage::begin(std::move(exhibit), settings);
    for (int i = 0; i < visitors; i++) join(96, 64, "en", i == 2 ? "kiosk" : "visitor");
    run(0.5);
  }
  void hour(const json& value, size_t visitor = 0) {
    say(json{{"type", "hour"}, {"value", value}}.dump(), visitor);
  }
  Visitor& of(size_t visitor) { return *std::next(show->visits.visitors.begin(), long(visitor)); }
  DynamicLights lights(size_t visitor) { return dynamic_lights_of(*show, of(visitor), show->time); }
  double level(size_t visitor) {
    Image8 shown = last_image(visitor);
    double sum = 0;
    for (uint8_t value : shown.rgb) sum += value;
    return sum / double(shown.rgb.size());
  }
};

TEST_F(Hour, IsTheExhibitsOwnAtFirstAndNothingMoves) {
  begin(1);
  EXPECT_EQ(last("welcome")["day"], json::parse(R"({"from":5.0,"to":22.0,"at":12.0,"hour":12.0})"));
  EXPECT_EQ(last("state")["hour"], 12);
  EXPECT_TRUE(lights(0).empty());
  EXPECT_EQ(show->stage.world->lamp_levels(), (LampLevels{lamp_full, lamp_full}));
}

TEST_F(Hour, DimsTheSkyAndMovesTheSunForWhoChoseIt) {
  begin(2, "gather");
  ASSERT_TRUE(show->stage.lights.maps);
  run(1);
  const double noon[2] = {level(0), level(1)};
  hour(16, 0);
  run(1);
  EXPECT_EQ(last("state", 0)["hour"], 16);
  EXPECT_EQ(last("state", 1)["hour"], 12);
  ASSERT_EQ(lights(0).size(), 1u);
  EXPECT_EQ(lights(0)[0].id, sun_of_the_day);
  const PunctualLight sun = eval_sun(*show->stage.exhibit.day, 16);
  EXPECT_EQ(lights(0)[0].light.direction, sun.direction);
  EXPECT_EQ(lights(0)[0].light.intensity, sun.intensity);
  EXPECT_TRUE(lights(1).empty());
  const double afternoon = level(0);
  EXPECT_LT(afternoon, 0.95 * noon[0]);
  hour(22, 0);
  run(1);
  EXPECT_TRUE(lights(0).empty()) << "the sun has set";
  EXPECT_LT(level(0), 0.6 * afternoon);
  EXPECT_NEAR(level(1) / noon[1], 1, 0.05);
  hour(nullptr, 0);
  run(1);
  EXPECT_EQ(last("state", 0)["hour"], 12);
  EXPECT_TRUE(lights(0).empty());
  EXPECT_NEAR(level(0) / noon[0], 1, 0.05);
}

TEST_F(Hour, DaylightIsSwitchedAtAnyHour) {
  begin(1);
  hour(15);
  run(0.5);
  EXPECT_EQ(lights(0).size(), 1u);
  say(R"({"type":"lamp","name":"daylight","on":false})");
  run(0.5);
  EXPECT_TRUE(lights(0).empty());
  EXPECT_EQ(of(0).lamps.lit, (LampLevels{0, 0}));
  EXPECT_EQ(last("state")["hour"], 15);
  EXPECT_EQ(last("state")["lamps"]["daylight"], false);
}

// No more than three flashes a second, whatever a page sends.
TEST_F(Hour, TheLightChangesAFewTimesASecondAtMost) {
  begin(1);
  run(1);
  int changes = 0;
  for (int i = 0; i < 50; i++) {
    const std::optional<double> before = of(0).lamps.lit_hour;
    hour(i % 2 ? 6 : 14);
    step();
    changes += before != of(0).lamps.lit_hour;
  }
  EXPECT_LE(changes, 6);
  EXPECT_GE(changes, 1);
  run(0.5);
  EXPECT_EQ(of(0).lamps.lit_hour, 6) << "what was asked for last";
}

TEST_F(Hour, FollowersSeeTheirLeadersAndAreNotAsked) {
  begin(2);
  order(R"({"type":"group","action":"lead"})", 0);
  const std::string code = last("group", 0)["code"];
  order(R"({"type":"group","action":"follow","code":")" + code + R"("})", 1);
  hour(16, 0);
  run(0.5);
  EXPECT_EQ(last("state", 1)["hour"], 16);
  EXPECT_EQ(lights(1).size(), 1u);
  hour(9, 1);
  run(0.5);
  EXPECT_EQ(last("error", 1)["code"], "in_group");
  EXPECT_EQ(last("state", 1)["hour"], 16);
}

TEST_F(Hour, GoesOnWithTheVisit) {
  begin(1);
  hour(17.25);
  run(3);
  const std::string token = last("keep")["token"];
  begin(0);  // another program
  const size_t back = connect();
  say(json{{"type", "hello"}, {"width", 96}, {"height", 64}, {"resume", token}}.dump(), back);
  run(0.5);
  EXPECT_EQ(last("welcome", back)["day"]["hour"], 17.25);
  EXPECT_EQ(of(0).lamps.lit_hour, 17.25);
}

TEST_F(Hour, IsRefusedWhereThereIsNoDay) {
  ShowStage::begin(make_tiny_exhibit(), settings_for("direct", 50));
  join(64, 48);
  hour(9);
  run(0.2);
  EXPECT_EQ(last("error")["code"], "no_day");
  EXPECT_EQ(last("welcome")["day"], nullptr);
  EXPECT_FALSE(last("state").contains("hour"));
}

}  // namespace
}  // namespace wellspring::test
