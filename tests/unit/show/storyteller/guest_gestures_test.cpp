// SPDX-License-Identifier: Apache-2.0
// What a guest before a kiosk does with a hand.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "unit/show/ball_piece.h"
#include "unit/show/show_stage.h"

namespace wellspring::test {
namespace {

struct GuestGestures : testing::Test, ShowStage {
  void SetUp() override {
    Exhibit exhibit = make_tiny_exhibit();
    add_storyteller(exhibit, "anna", {-2, 0, 1});
    exhibit.stories.push_back(exhibit.stories[0]);
    exhibit.stories[1].id = "other";
    begin(std::move(exhibit), settings_for("direct"));
    show->kiosks.eyes.push_back(
        Eye{std::make_shared<Link>(99, LinkKind::eye, "test"), {}, -1e9, 0});
  }
  // Seen for a second, as the kiosk's program tells it.
  void make(const std::string& gesture, double seconds = 0.4) {
    for (const std::string& now : {gesture, std::string()})
      for (double end = this->now + seconds; this->now < end;) {
        Eye& eye = show->kiosks.eyes.front();
        eye.seen.state = Presence::person;
        eye.seen.people.assign(1, Person{});
        eye.seen.people[0].id = 1;
        eye.seen.people[0].gesture = now;
        eye.received = show->time;
        step();
      }
  }
  const std::string& told() const { return show->cast.teller.voice.story; }
};

TEST_F(GuestGestures, ADigitChoosesAStory) {
  join(32, 32, "en", "kiosk");
  steps(3);
  make("2");
  EXPECT_EQ(told(), "other");
  make("1");
  EXPECT_EQ(told(), "tale");
  make("7");
  EXPECT_EQ(told(), "tale") << "there is no such story";
  EXPECT_EQ(show->totals.gestures, 2u) << "each once";
  make("swipe_down");
  EXPECT_EQ(told(), "");
}

TEST_F(GuestGestures, AnOpenPalmStopsTheStory) {
  join(32, 32, "en", "kiosk");
  steps(3);
  make("1");
  EXPECT_EQ(told(), "tale");
  make("stop");
  EXPECT_EQ(told(), "");
  EXPECT_EQ(show->totals.gestures, 2u);
}

TEST_F(GuestGestures, ThePageIsToldWhereTheNearestPoints) {
  join(32, 32, "en", "kiosk");
  steps(3);
  auto told = [&] { return nlohmann::json::parse(show->kiosks.all[0].message); };
  auto point = [&](std::optional<vec2> at, vec3 from) {
    Eye& eye = show->kiosks.eyes.front();
    eye.seen.state = Presence::person;
    eye.seen.people.assign(1, Person{});
    eye.seen.people[0].id = 1;
    eye.seen.people[0].position = from;
    eye.seen.people[0].hands.resize(1);
    eye.seen.people[0].hands[0].points_at = at;
    eye.received = show->time;
    step();
  };
  point(vec2(0.1f, 0.2f), {0, 0, 1});
  EXPECT_FALSE(told().contains("points_at")) << "the screen's size is unknown";
  show->kiosks.all[0].settings.screen = {0.8f, 0.5f};
  point(vec2(0.2f, 0.125f), {0, 0, 1});
  EXPECT_EQ(told()["points_at"], (nlohmann::json{0.75, 0.25}));
  point({}, {0, 0, 1});
  EXPECT_FALSE(told().contains("points_at"));
}

TEST_F(GuestGestures, SwipesTurnThePages) {
  join(32, 32, "en", "kiosk");
  steps(3);
  make("swipe_left", 0.1);
  EXPECT_EQ(told(), "tale");
  EXPECT_EQ(show->cast.teller.voice.sentence, 0);
  make("swipe_left", 0.1);
  EXPECT_EQ(show->cast.teller.voice.sentence, 1);
  make("swipe_right", 0.1);
  EXPECT_EQ(show->cast.teller.voice.sentence, 0);
  make("swipe_down", 0.1);
  make("swipe_left", 0.1);
  EXPECT_EQ(told(), "other") << "the next";
  make("swipe_down", 0.1);
  make("swipe_right", 0.1);
  EXPECT_EQ(told(), "other") << "again";
}

TEST_F(GuestGestures, SwipesTurnAVolumeThatTheGuestWalksTo) {
  Exhibit exhibit = make_tiny_exhibit();
  add_storyteller(exhibit, "anna", {-2, 0, 1});
  add_ball(exhibit, dvec3(-2, 1, 1.5));
  browsers.clear();
  auto eyes = show->kiosks.eyes;
  begin(std::move(exhibit), settings_for("direct"));
  show->kiosks.eyes = eyes;
  join(32, 32, "en", "kiosk");
  steps(3);
  const auto turn = [&] { return glm::degrees(choice_of(visitor().pieces.wish, 0).turn); };
  visitor().place.view.position = dvec3(-2, 1.6, 3);
  visitor().place.view.yaw = 0;
  say(R"({"type":"kiosk","showing":"museum"})");
  make("swipe_left", 0.1);
  EXPECT_EQ(turn(), 0) << "only who walks turns it";
  EXPECT_EQ(told(), "tale");
  make("swipe_down", 0.1);
  say(R"({"type":"kiosk","showing":"walk"})");
  make("swipe_left", 0.1);
  EXPECT_NEAR(turn(), -30, 1e-3f);
  make("swipe_right", 0.1), make("swipe_right", 0.1);
  EXPECT_NEAR(turn(), 30, 1e-3f);
  EXPECT_EQ(told(), "");
  run(1.6);
  EXPECT_NEAR(choice_of(visitor().pieces.shown.choices, 0).turn, glm::radians(30.0f), 1e-4f);
  visitor().place.view.yaw = pi;
  make("swipe_left", 0.1);
  EXPECT_NEAR(turn(), 30, 1e-3f) << "behind one's back";
  EXPECT_FALSE(told().empty());
}

TEST_F(GuestGestures, MeanNothingWithoutAScreen) {
  join(32, 32);
  steps(3);
  make("1");
  EXPECT_EQ(told(), "");
  make("wave");
  make("point");
  EXPECT_EQ(show->totals.gestures, 0u);
}

}  // namespace
}  // namespace wellspring::test
