// SPDX-License-Identifier: Apache-2.0
#include "show/answer/idle.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "show/exhibit/exhibit_lights.h"
#include "unit/show/show_stage.h"

namespace wellspring::test {
namespace {

using nlohmann::json;

struct Idle : testing::Test, ShowStage {
  void SetUp() override {
    Exhibit exhibit = make_tiny_exhibit();
    add_storyteller(exhibit, "anna", {-2, 0, 1});
    ShowSettings settings = settings_for("direct", 10);
    settings.idle_after = 20, settings.idle_answer = 5, settings.hidden_after = 4;
    tick_seconds = 0.1;
    begin(std::move(exhibit), settings);
  }
  std::string asked(size_t visitor = 0) {
    const json said = last("idle", visitor);
    return said.is_null() ? "" : said["state"].get<std::string>();
  }
  bool is_there(size_t visitor = 0) {
    return std::ranges::any_of(show->visits.visitors, [&](const Visitor& one) {
      return one.link == browsers[visitor].link;
    });
  }
  void here(bool is, size_t visitor = 0) {
    say(json{{"type", "presence"}, {"here", is}}.dump(), visitor);
  }
};

TEST_F(Idle, WhoDoesNothingIsAskedAndThenRests) {
  join(32, 32);
  run(19.5);
  EXPECT_EQ(asked(), "");
  run(1);
  EXPECT_EQ(last("idle"), json({{"type", "idle"}, {"state", "asked"}, {"seconds", 5}}));
  run(4);
  EXPECT_TRUE(is_there());
  run(1.5);
  EXPECT_FALSE(is_there());
  EXPECT_EQ(asked(), "paused");
  ASSERT_EQ(show->visits.resting.size(), 1u);
  EXPECT_EQ(show->visits.resting[0], browsers[0].link);
  EXPECT_FALSE(browsers[0].link->closed());
  EXPECT_EQ(told("idle").size(), 2u) << "each is said once";
}

TEST_F(Idle, AnyInputAnswers) {
  join(32, 32);
  run(21);
  ASSERT_EQ(asked(), "asked");
  here(true);
  run(0.2);
  EXPECT_EQ(asked(), "here");
  run(19);
  EXPECT_TRUE(is_there());
  run(1.5);
  ASSERT_EQ(asked(), "asked");
  turn(0.1);
  run(6);
  EXPECT_TRUE(is_there());
  EXPECT_EQ(asked(), "here");
}

TEST_F(Idle, WhatAPageSaysByItselfIsNoAnswer) {
  join(32, 32);
  browsers[0].acknowledges = true;
  for (int i = 0; i < 26; i++) {
    say(R"({"type":"settings","width":32,"height":32})");
    say(R"({"type":"input","seq":1,"move":[0,0,0],"look":[0,0]})");
    run(1);
  }
  EXPECT_FALSE(is_there());
}

TEST_F(Idle, AVisitGoesOnWhereItRested) {
  join(32, 32);
  order(R"({"type":"viewpoint","seq":1,"name":"corner"})");
  order(R"({"type":"settings","width":48,"height":32})");
  run(26);
  ASSERT_EQ(show->visits.resting.size(), 1u);
  auto link = show->visits.resting[0];
  const json hello = json::parse(link->first_heard()->text);
  EXPECT_EQ(hello["type"], "hello");
  EXPECT_EQ(hello["width"], 48);
  show->visits.resting.clear();
  arrivals.put(link);  // as the reception does
  run(1);
  EXPECT_TRUE(is_there());
  EXPECT_EQ(last("welcome")["resumed"], true);
  EXPECT_EQ(last("state")["viewpoint"], "corner");
  EXPECT_EQ(show->totals.visits, 1u);
}

TEST_F(Idle, AHiddenPageGetsNoPicturesAndRestsSoon) {
  join(32, 32);
  run(1);
  here(false);
  run(0.2);
  const size_t pictures = browsers[0].pictures.size(), drawn = show->totals.drawn;
  turn(0.3);
  run(2);
  EXPECT_EQ(browsers[0].pictures.size(), pictures);
  EXPECT_EQ(show->totals.drawn, drawn);
  here(true);
  run(1);
  EXPECT_GT(browsers[0].pictures.size(), pictures);
  here(false);
  run(4.5);
  EXPECT_FALSE(is_there());
  EXPECT_EQ(asked(), "paused");
}

TEST_F(Idle, WhoIsToldAStoryIsNotAsked) {
  join(32, 32);
  order(R"({"type":"storyteller","story":"tale"})");
  here(false);
  step_until([&] { return last("agent")["story"].is_null(); });
  EXPECT_TRUE(is_there());
  run(5);
  EXPECT_FALSE(is_there());
}

TEST_F(Idle, KiosksAndLeadersOfAGroupAreNotAsked) {
  join(32, 32, "en", "kiosk");
  const size_t leader = join(32, 32), follower = join(32, 32);
  run(0.2);
  order(R"({"type":"group","action":"lead"})", leader);
  const std::string code = last("group", leader)["code"];
  order(json{{"type", "group"}, {"action", "follow"}, {"code", code}}.dump(), follower);
  for (int i = 0; i < 30; i++) {
    say(R"({"type":"input","seq":1,"look":[0.1,0]})", follower);
    run(1);
  }
  EXPECT_TRUE(is_there(0) && is_there(leader) && is_there(follower));
  EXPECT_EQ(asked(0) + asked(leader) + asked(follower), "");
}

TEST_F(Idle, AClockThatJumpsSendsNobodyToRest) {
  join(32, 32);
  run(1);
  now += 3600;
  run(1);
  EXPECT_TRUE(is_there());
  EXPECT_EQ(asked(), "");
}

TEST_F(Idle, WhoRestsOrHasGoneGivesTheirSeatBack) {
  auto capacity = std::make_shared<Capacity>(CapacitySettings{.cores = 64});
  auto come = [&] {
    const size_t number = browsers.size();
    browsers.push_back({std::make_shared<Link>(number + 1, LinkKind::visit, "test")});
    arrivals.put(browsers[number].link, capacity->find_seat(32 * 32));
    say(R"({"type":"hello","width":64,"height":32})", number);
    run(1);
    return number;
  };
  come();
  const size_t gone = come();
  EXPECT_EQ(capacity->standing().seats, 2);
  browsers[gone].link->mark_closed();
  run(0.5);
  EXPECT_EQ(show->visits.kept.size(), 1u);
  EXPECT_EQ(capacity->standing().seats, 1);
  const auto standing = capacity->standing();
  EXPECT_NEAR(standing.busy, cores_a_pixel(standing.cost, 15, false) * weighed_pixels(64 * 32),
              1e-9)
      << "of the size that it has";
  run(26);
  EXPECT_EQ(capacity->standing().seats, 0);
}

}  // namespace
}  // namespace wellspring::test
