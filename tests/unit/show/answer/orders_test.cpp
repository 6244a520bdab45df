// SPDX-License-Identifier: Apache-2.0
// Orders by the hundred: the last of a kind wins, and others are drawn as ever.
#include "show/answer/orders.h"

#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "show/exhibit/exhibit_lights.h"
#include "show/state/lamps.h"
#include "show/state/visitor_picture.h"
#include "unit/show/show_stage.h"
#include "world/load/lamp.h"

namespace wellspring::test {
namespace {

using nlohmann::json;

Exhibit make_room() {
  Exhibit exhibit = make_tiny_exhibit();
  add_storyteller(exhibit, "anna", {-2, 0, 1});
  add_storyteller(exhibit, "otto", {-1, 0, 2});
  add_lamp({"ceiling", {"light"}, {}}, exhibit.scene);
  exhibit.lamps = {{"ceiling", {{"en", "Ceiling"}}}};
  return exhibit;
}

struct Orders : testing::Test, ShowStage {
  void SetUp() override { begin(); }
  void begin() {
    browsers.clear();
    ShowStage::begin(make_room(), settings_for("direct", 25));
    for (int i = 0; i < 2; i++) join(32, 32);
    run(0.5);
  }
  std::string input(double yaw) {
    return json{{"type", "input"}, {"seq", ++seq}, {"look", {yaw, 0}}}.dump();
  }
  Visitor& other() { return show->visits.visitors.back(); }
};

TEST_F(Orders, OfOneKindTheNewestIsCarriedOutATick) {
  const uint64_t before = show->totals.orders_left_out;
  for (const char* who : {"otto", "anna", "otto", "anna", "otto"})
    say(json{{"type", "storyteller"}, {"teller", who}}.dump());
  for (int width : {64, 96, 128}) say(json{{"type", "settings"}, {"width", width}}.dump());
  step();
  EXPECT_EQ(show->totals.orders_left_out - before, 6u);
  EXPECT_EQ(visitor().own_teller->index, 1u);
  EXPECT_EQ(visitor().wants.width, 128);
}

TEST_F(Orders, WhatTheNewerOneDoesNotSayStays) {
  say(R"({"type":"storyteller","visible":false})");
  say(R"({"type":"storyteller","humanlike":false})");
  say(R"({"type":"storyteller","story":"none"})");
  say(R"({"type":"storyteller","story":"tale"})");
  say(R"({"type":"storyteller","action":"pause"})");
  say(R"({"type":"settings","quality":40})");
  say(R"({"type":"settings","fps":7,"lang":"de"})");
  step();
  const Teller& teller = *visitor().own_teller;
  EXPECT_FALSE(teller.visible);
  EXPECT_FALSE(teller.humanlike);
  EXPECT_EQ(teller.voice.story, "tale");
  EXPECT_TRUE(teller.voice.paused);
  EXPECT_EQ(visitor().wants.best_quality, 40);
  EXPECT_EQ(visitor().wants.fps, 7);
  EXPECT_EQ(visitor().lang, "de");
  EXPECT_TRUE(told("error").empty()) << "nobody waits for the story that is not there";
}

TEST_F(Orders, TwoLampsAreTwoKinds) {
  say(R"({"type":"lamp","name":"ceiling","on":false})");
  say(R"({"type":"lamp","name":"none","on":false})");
  step();
  EXPECT_EQ(lamps_of(*show, visitor())[0].level, 0);
  EXPECT_EQ(told("error").size(), 1u);
}

TEST_F(Orders, TurnsAddUpAndEverySeqIsAnswered) {
  const float before = visitor().place.view.yaw;
  for (int i = 0; i < 100; i++) say(input(0.01));
  step();
  EXPECT_NEAR(visitor().place.view.yaw - before, 1, 1e-4);
  EXPECT_EQ(visitor().place.seq, seq);
  // A place, a turn there, another place, and a turn there.
  for (const char* name : {"door", "corner"}) {
    say(json{{"type", "viewpoint"}, {"seq", ++seq}, {"name", name}}.dump());
    say(input(0.25));
  }
  step();
  const Viewpoint& corner = show->stage.exhibit.viewpoints[1].view;
  EXPECT_EQ(visitor().place.view.position, corner.position);
  EXPECT_NEAR(visitor().place.view.yaw, corner.yaw + 0.25, 1e-5);
  EXPECT_EQ(visitor().place.seq, seq);
}

TEST_F(Orders, BeyondTheRateOfAKindTheLastOneWinsWhenItIsDue) {
  const double began = now;
  uint64_t carried_out = 0;
  const double rate =
      std::ranges::find(order_bounds(), std::string(Settings::type), [](const OrderBound& one) {
        return std::string(one.type);
      })->rate;
  int width = 0, seen = visitor().wants.width;
  for (int i = 0; i < 300; i++) {
    width = 64 + 8 * (i % 40);
    say(json{{"type", "settings"}, {"width", width}}.dump());
    step();
    if (visitor().wants.width != seen) carried_out++, seen = visitor().wants.width;
  }
  EXPECT_GE(carried_out, 10u);
  EXPECT_LE(double(carried_out), rate * (now - began) + 10);
  run(1 / rate + tick_seconds);
  EXPECT_EQ(visitor().wants.width, width);
  EXPECT_TRUE(visitor().orders.waiting.empty());
}

TEST_F(Orders, ThatCannotBeCarriedOutDoNotPileUp) {
  for (int i = 0; i < 200; i++)
    say(json{{"type", "lamp"}, {"name", "lamp" + std::to_string(i)}, {"on", true}}.dump());
  say(R"({"type":"lamp","name":"ceiling","on":false})");
  step();
  EXPECT_LE(visitor().orders.waiting.size(), most_waiting_orders);
  run(6);
  EXPECT_EQ(lamps_of(*show, visitor())[0].level, 0) << "the last one wins";
}

// An order that comes late does not take back what inputs since then have been told.
TEST_F(Orders, ALateOneDoesNotTurnBackTheNumberOfTheLastInput) {
  for (int i = 0; i < 40; i++) {
    say(json{{"type", "viewpoint"}, {"seq", ++seq}, {"name", i % 2 ? "door" : "corner"}}.dump());
    say(input(0.01));
    step();
    EXPECT_EQ(visitor().place.seq, seq);
  }
  run(1);
  EXPECT_EQ(visitor().place.seq, seq);
}

// Everything that can be ordered, each as often as the socket takes it, beside one who walks.
TEST_F(Orders, WhoeverOrdersTooMuchDoesNotKeepOthersFromBeingDrawn) {
  const std::vector<std::function<json(int)>> storms = {
      [](int i) {
        return json{{"type", "camera"},
                    {"seq", i + 1},
                    {"position", {i % 2 ? 3 : -3, 1.6, i % 2 ? -3 : 3}}};
      },
      [](int i) {
        return json{{"type", "viewpoint"}, {"seq", i + 1}, {"name", i % 2 ? "door" : "corner"}};
      },
      [](int i) {
        return json{{"type", "storyteller"}, {"teller", i % 2 ? "anna" : "otto"}};
      },
      [](int i) {
        return json{{"type", "storyteller"}, {"visible", i % 2 == 0}};
      },
      [](int) {
        return json{{"type", "storyteller"}, {"story", "tale"}};
      },
      [](int i) {
        return json{{"type", "settings"}, {"width", 32 + 16 * (i % 2)}};
      },
      [](int i) {
        return json{{"type", "lamp"}, {"name", "ceiling"}, {"on", i % 2 == 0}};
      },
  };
  for (const auto& storm : storms) {
    begin();
    const double began = other().picture->drawn_at;
    int drawn = 0, ticks = 0;
    for (double last = began; drawn < 10 && ticks < 20000; ticks++) {
      for (int i = 0; i < 6; i++) say(storm(6 * ticks + i).dump());
      turn(0.02, 0, 1);
      step_on();
      if (other().picture->drawn_at > last) last = other().picture->drawn_at, drawn++;
    }
    EXPECT_EQ(drawn, 10) << storm(0) << " in " << ticks << " ticks";
  }
}

}  // namespace
}  // namespace wellspring::test
