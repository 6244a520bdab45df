// SPDX-License-Identifier: Apache-2.0
// Two visitors who do not know one another: what one says changes nothing for the other.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "show/exhibit/exhibit_lights.h"
#include "unit/show/show_stage.h"
#include "wire/json.h"

namespace wellspring::test {
namespace {

using nlohmann::json;

Exhibit make_shared_room(bool shared) {
  Exhibit exhibit = make_tiny_exhibit();
  for (int i : {0, 1}) {
    StorytellerPlace& place =
        add_storyteller(exhibit, i == 0 ? "anna" : "otto", dvec3(-2 + i, 0, 1 + i));
    place.name = {{"en", i == 0 ? "Anna" : "Otto"}};
  }
  exhibit.shared_storyteller = shared;
  add_day(exhibit);
  exhibit.lamps = {{"ceiling", {{"en", "Ceiling"}}, true, shared}};
  return exhibit;
}

struct MineAndOurs : testing::Test, ShowStage {
  void begin(bool shared) {
    browsers.clear();
    tick_seconds = 0.04;
    ShowStage::begin(make_shared_room(shared), settings_for("direct", 25));
    for (int i = 0; i < 2; i++) join(32, 32);
    run(0.5);
  }
  // Returns the second visitor's messages, without fields that the machine's work and a glance
  // change.
  std::vector<json> told_to_other() {
    std::vector<json> all;
    for (const std::string& text : browsers[1].texts) {
      json message = json::parse(text);
      for (const char* name : {"fps", "converged", "gaze", "looking_at", "guest", "face", "token"})
        message.erase(name);
      all.push_back(message);
    }
    return all;
  }
};

// Every type of the protocol must have a row here.
const std::vector<std::string> orders = {
    R"({"type":"hello","role":"visitor","width":48,"height":48,"lang":"de"})",
    R"({"type":"input","seq":1,"move":[0,0,1],"look":[0.3,0.1],"pointer":[0.5,0.5]})",
    R"({"type":"camera","seq":2,"position":[3,1.6,-3],"yaw":1})",
    R"({"type":"viewpoint","seq":3,"name":"corner"})",
    R"({"type":"go","seq":4,"to":[0,0,0]})",
    R"({"type":"tour","action":"play"})",
    R"({"type":"tour","action":"stop"})",
    R"({"type":"storyteller","teller":"otto"})",
    R"({"type":"storyteller","visible":false,"humanlike":false})",
    R"({"type":"storyteller","story":"tale"})",
    R"({"type":"storyteller","action":"skip"})",
    R"({"type":"storyteller","action":"pause"})",
    R"({"type":"storyteller","action":"stop"})",
    R"({"type":"ask","text":"What is this?"})",
    R"({"type":"lamp","name":"ceiling","on":false})",
    R"({"type":"hour","value":20})",
    R"({"type":"piece","name":"map","layer":"1850"})",
    R"({"type":"lens","seq":1,"at":[0.5,0.5],"zoom":2})",
    R"({"type":"measure","from":[0.4,0.5],"to":[0.6,0.5]})",
    R"({"type":"play","name":"door","on":true})",
    R"({"type":"group","action":"lead"})",
    R"({"type":"kiosk","showing":"book","touched":true,"playing":true})",
    R"({"type":"settings","fps":10,"quality":30,"attention":false,"lang":"de","width":64})",
    R"({"type":"ack","frame":1,"decoded_ms":900})",
    R"({"type":"presence","here":true})",
    R"({"type":"nonsense"})",
    R"({"type":"bye"})",
};

TEST_F(MineAndOurs, NothingThatOneSaysChangesAnythingForTheOther) {
  std::set<std::string> types;
  for (const std::string& text : orders) types.insert(json::parse(text)["type"]);
  const json messages = describe_browser_messages();
  for (const auto& [type, fields] : messages.items()) EXPECT_TRUE(types.contains(type)) << type;
  std::vector<json> told[2];
  Image8 seen[2];
  for (int i : {0, 1}) {
    begin(false);
    for (const std::string& text : orders) {
      if (i == 1) say(text, 0);
      run(0.6);
    }
    run(8);  // the picture is without noise by then
    told[i] = told_to_other();
    seen[i] = last_image(1);
  }
  ASSERT_GT(told[0].size(), 20u);
  // How often the same is said depends on when pictures are drawn.
  EXPECT_EQ(std::set(told[0].begin(), told[0].end()), std::set(told[1].begin(), told[1].end()));
  // Diffuse light that is learned meanwhile changes a picture by up to 7 grey levels, another place
  // by 70. Lamps and the hour are told as well.
  EXPECT_LT(mean_difference(seen[0], seen[1]), 12);
}

TEST_F(MineAndOurs, EachHasTheirOwnStorytellerWhoTellsThemAlone) {
  begin(false);
  order(R"({"type":"storyteller","teller":"otto"})", 0);
  EXPECT_EQ(last("agent", 0)["teller"], "otto");
  EXPECT_EQ(last("agent", 1)["teller"], "anna");
  order(R"({"type":"storyteller","story":"tale"})", 1);
  EXPECT_EQ(last("agent", 0)["story"], nullptr);
  EXPECT_EQ(last("agent", 1)["story"], "tale");
  EXPECT_EQ(last("subtitle", 1)["speaker"], "Anna");
  EXPECT_TRUE(told("subtitle", 0).empty());
  order(R"({"type":"storyteller","story":"tale"})", 0);
  order(R"({"type":"storyteller","action":"pause"})", 0);
  EXPECT_EQ(last("agent", 0)["paused"], true);
  EXPECT_EQ(last("agent", 1)["paused"], false);
  EXPECT_EQ(last("subtitle", 0)["speaker"], "Otto");
  EXPECT_TRUE(told("error", 0).empty() && told("error", 1).empty());
}

// The one figure in the world stands as each visitor's own storyteller does while their picture is
// made.
TEST_F(MineAndOurs, WhoHidesHerHidesHerFromThemselves) {
  begin(false);
  for (size_t i : {0, 1}) {
    Visitor& visitor = *std::next(show->visits.visitors.begin(), long(i));
    visitor.place.view.position = {-2, 0.3, 2};
    visitor.place.view.yaw = visitor.place.view.pitch = 0;
  }
  // The figure is bright before the wall, which is the picture's upper half.
  auto stands_out = [&](size_t i) {
    const Image8 picture = last_image(i);
    double brightest = 0, sum = 0;
    const size_t values = picture.rgb.size() / 2;
    for (size_t v = 0; v < values; v++) {
      brightest = std::max(brightest, double(picture.rgb[v]));
      sum += picture.rgb[v];
    }
    return brightest - sum / double(values) > 32;
  };
  // The figure is small, so its light takes a while, and longer on a busy machine.
  run(40);
  for (int i = 0; i < 20 && !(stands_out(0) && stands_out(1)); i++) run(10);
  ASSERT_TRUE(stands_out(0) && stands_out(1));
  order(R"({"type":"storyteller","visible":false})", 0);
  run(2);
  for (int i = 0; i < 20 && stands_out(0); i++) run(2);
  EXPECT_FALSE(stands_out(0));
  EXPECT_TRUE(stands_out(1));
  EXPECT_EQ(last("agent", 1)["visible"], true);
}

TEST_F(MineAndOurs, WhatTheExhibitSharesIsEverybodys) {
  begin(true);
  order(R"({"type":"storyteller","teller":"otto"})", 0);
  EXPECT_EQ(last("agent", 1)["teller"], "otto");
  order(R"({"type":"storyteller","story":"tale"})", 1);
  EXPECT_EQ(last("agent", 0)["story"], "tale");
  EXPECT_EQ(last("subtitle", 0)["text"], last("subtitle", 1)["text"]);
  order(R"({"type":"lamp","name":"ceiling","on":false})", 0);
  run(0.6);
  EXPECT_EQ(last("state", 1)["lamps"]["ceiling"], false);
  for (const Visitor& visitor : show->visits.visitors) EXPECT_EQ(visitor.own_teller, nullptr);
}

// A kiosk's guests have the house's storyteller: nobody far away takes it from them, nor do they
// take a visitor's.
TEST_F(MineAndOurs, AKioskHasTheHousesStoryteller) {
  begin(false);
  const size_t page = join(32, 32, "en", "kiosk");
  run(0.2);
  order(R"({"type":"storyteller","story":"tale"})", page);
  EXPECT_EQ(last("agent", 1)["story"], "tale") << "who only looks on hears what is told";
  order(R"({"type":"storyteller","teller":"otto"})", 0);
  EXPECT_EQ(last("agent", 0)["story"], nullptr);
  EXPECT_EQ(last("agent", page)["story"], "tale");
  EXPECT_EQ(last("agent", page)["teller"], "anna");
  order(R"({"type":"storyteller","action":"stop"})", page);
  EXPECT_EQ(last("agent", 0)["teller"], "otto");
}

}  // namespace
}  // namespace wellspring::test
