// SPDX-License-Identifier: Apache-2.0
#include "show/answer/groups.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "show/exhibit/exhibit_lights.h"
#include "unit/show/show_stage.h"
#include "world/load/lamp.h"

namespace wellspring::test {
namespace {

struct Groups : testing::Test, ShowStage {
  std::string code;
  void SetUp() override {
    Exhibit exhibit = make_tiny_exhibit();
    add_storyteller(exhibit, "anna", {-2, 0, 1});
    add_lamp({"ceiling", {"light"}, {}}, exhibit.scene);
    exhibit.lamps = {{"ceiling", {{"en", "Ceiling"}}}};
    tick_seconds = 0.04;
    begin(std::move(exhibit), settings_for("direct", 25));
    for (int i = 0; i < 3; i++) join(32, 32);  // a leader, a follower, a stranger
    run(0.2);
    order(R"({"type":"group","action":"lead"})", 0);
    code = last("group", 0)["code"];
    order(R"({"type":"group","action":"follow","code":")" + code + R"("})", 1);
  }
  const VisitorPlace& place(size_t i) {
    return std::next(show->visits.visitors.begin(), long(i))->place;
  }
};

TEST_F(Groups, FollowersGoWhereTheLeaderGoesAndStrangersDoNot) {
  EXPECT_EQ(last("group", 0)["followers"], 1);
  EXPECT_EQ(last("group", 1)["role"], "follower");
  EXPECT_TRUE(told("group", 2).empty());
  order(R"({"type":"viewpoint","seq":1,"name":"corner"})", 0);
  EXPECT_EQ(place(1).view.position, place(0).view.position);
  EXPECT_EQ(last("state", 1)["position"], last("state", 0)["position"]);
  EXPECT_NE(place(2).view.position, place(0).view.position);
  order(R"({"type":"input","seq":2,"move":[0,0,1]})", 0);
  run(1);
  EXPECT_EQ(place(1).view.position, place(0).view.position);
}

TEST_F(Groups, FollowersLookRoundAndTheirViewComesBack) {
  const float ahead = place(0).view.yaw;
  order(R"({"type":"input","seq":1,"look":[0.8,0.2]})", 1);
  EXPECT_NEAR(place(1).view.yaw, ahead + 0.8f, 1e-4f);
  EXPECT_EQ(place(0).view.yaw, ahead);
  run(look_round_seconds - 0.3);
  EXPECT_NEAR(place(1).view.yaw, ahead + 0.8f, 1e-4f);
  run(4);
  EXPECT_NEAR(place(1).view.yaw, ahead, 0.01f);
}

TEST_F(Groups, WhoWalksOffIsAwayUntilTheyRejoin) {
  order(R"({"type":"input","seq":1,"move":[0,0,1]})", 1);
  EXPECT_EQ(last("group", 1)["away"], true);
  order(R"({"type":"input","seq":2,"move":[0,0,0]})", 1);
  run(1);
  EXPECT_NE(place(1).view.position, place(0).view.position);
  order(R"({"type":"group","action":"rejoin"})", 1);
  EXPECT_EQ(last("group", 1)["away"], false);
  EXPECT_EQ(place(1).view.position, place(0).view.position);
}

TEST_F(Groups, TheLeadersStorytellerTourAndLampsAreTheGroups) {
  order(R"({"type":"storyteller","story":"tale"})", 0);
  EXPECT_EQ(last("agent", 1)["story"], "tale");
  EXPECT_EQ(last("agent", 2)["story"], nullptr);
  EXPECT_EQ(last("subtitle", 1)["text"], last("subtitle", 0)["text"]);
  order(R"({"type":"lamp","name":"ceiling","on":false})", 0);
  run(0.6);
  EXPECT_EQ(last("state", 1)["lamps"]["ceiling"], false);
  EXPECT_EQ(last("state", 2)["lamps"]["ceiling"], true);
  for (const char* text :
       {R"({"type":"storyteller","action":"stop"})",
        R"({"type":"lamp","name":"ceiling","on":true})", R"({"type":"tour","action":"play"})"}) {
    order(text, 1);
    EXPECT_EQ(last("error", 1)["code"], "in_group") << text;
  }
  EXPECT_EQ(last("agent", 0)["story"], "tale");
  order(R"({"type":"tour","action":"play"})", 0);
  run(1);
  EXPECT_EQ(last("subtitle", 1)["text"], last("subtitle", 0)["text"]);
  EXPECT_NE(last("subtitle", 1)["text"], "");
  EXPECT_EQ(place(1).view.position, place(0).view.position);
  order(R"({"type":"group","action":"leave"})", 1);
  EXPECT_EQ(last("agent", 1)["story"], nullptr);
  run(0.6);
  EXPECT_EQ(last("state", 1)["lamps"]["ceiling"], true);
}

TEST_F(Groups, EndsWhenTheLeaderLeavesAndCodesAreChecked) {
  order(R"({"type":"group","action":"follow","code":"AAAAAA"})", 2);
  EXPECT_EQ(last("error", 2)["code"], "unknown_group");
  order(R"({"type":"group","action":"rejoin"})", 2);
  EXPECT_EQ(last("error", 2)["code"], "no_group");
  std::string typed = code.substr(0, 3) + "-" + code.substr(3);
  for (char& c : typed) c = char(std::tolower(c));
  order(R"({"type":"group","action":"follow","code":")" + typed + R"("})", 2);
  EXPECT_EQ(last("group", 0)["followers"], 2);
  order(R"({"type":"group","action":"leave"})", 0);
  for (size_t i : {1, 2}) {
    EXPECT_EQ(last("group", i)["role"], "none");
    EXPECT_TRUE(std::next(show->visits.visitors.begin(), long(i))->group.follows.empty());
  }
}

}  // namespace
}  // namespace wellspring::test
