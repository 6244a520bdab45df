// SPDX-License-Identifier: Apache-2.0
#include "show/answer/come_back.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "show/exhibit/exhibit_lights.h"
#include "show/state/visitor_picture.h"
#include "unit/folder.h"
#include "unit/show/show_stage.h"
#include "world/load/lamp.h"

namespace wellspring::test {
namespace {

using nlohmann::json;

struct ComeBack : testing::Test, ShowStage {
  test::Folder folder;
  void open(int64_t day = 100) {
    browsers.clear();
    show.reset();
    Exhibit exhibit = make_tiny_exhibit();
    add_storyteller(exhibit, "anna", {-2, 0, 1});
    add_storyteller(exhibit, "otto", {-2, 0, 2});
    add_lamp({"ceiling", {"light"}, {}}, exhibit.scene);
    exhibit.lamps = {{"ceiling", {{"en", "Ceiling"}}}};
    ShowSettings settings = settings_for("direct", 10);
    settings.cache = folder.path;
    settings.bakes = false;
    tick_seconds = 0.1;
    begin(std::move(exhibit), settings);
    show->house.local_time.day = day;
  }
  void SetUp() override { open(); }
  std::string token(size_t visitor = 0) { return last("keep", visitor)["token"]; }
  size_t come(const std::string& token) {
    const size_t number = connect();
    say(json{{"type", "hello"}, {"width", 32}, {"height", 32}, {"resume", token}}.dump(), number);
    run(0.1);
    return number;
  }
  void break_line(size_t visitor = 0) {
    browsers[visitor].link->mark_closed();
    run(0.2);
  }
  // Lets a visitor do what shall last.
  void begin_visit() {
    join(32, 32);
    order(R"({"type":"viewpoint","seq":1,"name":"corner"})");
    order(R"({"type":"lamp","name":"ceiling","on":false})");
    order(R"({"type":"storyteller","teller":"otto","humanlike":false})");
    order(R"({"type":"storyteller","story":"tale"})");
    order(R"({"type":"storyteller","action":"skip"})");
    order(R"({"type":"storyteller","action":"pause"})");
    order(R"({"type":"group","action":"lead"})");
    run(2.5);
  }
  void expect_visit(size_t visitor) {
    EXPECT_EQ(last("welcome", visitor)["resumed"], true);
    EXPECT_EQ(last("welcome", visitor)["lamps"][0]["on"], false);
    EXPECT_EQ(last("state", visitor)["viewpoint"], "corner");
    EXPECT_EQ(last("agent", visitor)["teller"], "otto");
    EXPECT_EQ(last("agent", visitor)["story"], "tale");
    EXPECT_EQ(last("agent", visitor)["paused"], true);
    const Visitor& now = show->visits.visitors.back();
    ASSERT_TRUE(now.own_teller);
    EXPECT_EQ(now.own_teller->voice.sentence, 1);
    EXPECT_FALSE(now.own_teller->humanlike);
  }
};

TEST_F(ComeBack, AVisitWhoseLineBrokeGoesOnWithWhatItKnows) {
  begin_visit();
  const size_t points = visitor().picture->cache.stats().points;
  ASSERT_GT(points, 0u);
  const std::string code = last("group")["code"];
  break_line();
  EXPECT_TRUE(show->visits.visitors.empty());
  EXPECT_EQ(show->totals.visits, 1u);
  const size_t again = come(token());
  expect_visit(again);
  EXPECT_GE(show->visits.visitors.front().picture->cache.stats().points, points);
  EXPECT_EQ(show->visits.visitors.front().group.leads, code);
  EXPECT_EQ(show->totals.visits, 1u);
  EXPECT_TRUE(show->visits.kept.empty());
}

// A picture of who is here may be drawn on another thread, so it is not exchanged for a kept one.
TEST_F(ComeBack, WhoIsHereAlreadyTakesNoKeptVisit) {
  begin_visit();
  const std::string sealed = token();
  break_line();
  ASSERT_EQ(show->visits.kept.size(), 1u);
  const size_t other = join(32, 32);
  step();
  say(json{{"type", "hello"}, {"width", 32}, {"height", 32}, {"resume", sealed}}.dump(), other);
  run(0.2);
  EXPECT_NE(last("welcome", other)["resumed"], true);
  EXPECT_EQ(show->visits.kept.size(), 1u);
  expect_visit(come(sealed));
  EXPECT_TRUE(show->visits.kept.empty());
}

TEST_F(ComeBack, NorDoesWhoHasSaidGoodbye) {
  begin_visit();
  const std::string sealed = token();
  break_line();
  const size_t other = join(32, 32);
  step();
  const std::string hello =
      json{{"type", "hello"}, {"width", 32}, {"height", 32}, {"resume", sealed}}.dump();
  for (const std::string& text : {std::string(R"({"type":"bye"})"), hello}) {
    say(text, other);
    visitor().picture->at_work = true;  // as if the renderer drew it
    step();
    ASSERT_EQ(show->visits.visitors.size(), 1u);
    EXPECT_FALSE(visitor().welcomed);
    EXPECT_EQ(show->visits.kept.size(), 1u);
  }
  visitor().picture->at_work = false;
  step();
  EXPECT_TRUE(show->visits.visitors.empty());
}

TEST_F(ComeBack, LaterAndAfterANewStartItIsWhereItWas) {
  begin_visit();
  const std::string code = last("group")["code"], sealed = token();
  break_line();
  run(kept_seconds + 1);
  EXPECT_TRUE(show->visits.kept.empty());
  expect_visit(come(sealed));
  EXPECT_EQ(show->visits.visitors.front().group.leads, code);
  open();
  expect_visit(come(sealed));
  EXPECT_EQ(show->totals.stories, 0u) << "it was counted when it was begun";
  const size_t second = come(sealed);
  expect_visit(second);
  EXPECT_EQ(show->visits.visitors.back().group.leads, "") << "a group has one leader";
}

TEST_F(ComeBack, TheTokenOfWhoCameToRestIsNotOlderThanTheMove) {
  join(32, 32);
  run(2.1);  // one has just been sent
  order(R"({"type":"viewpoint","seq":1,"name":"corner"})");
  run(0.5);
  const std::string sealed = token();
  open();
  come(sealed);
  EXPECT_EQ(last("state", 0)["viewpoint"], "corner");
}

TEST_F(ComeBack, ATourGoesOnAtItsStop) {
  join(32, 32);
  order(R"({"type":"tour","action":"play"})");
  ASSERT_TRUE(step_until([&] { return visitor().place.tour.stop == 1; }));
  run(2.5);
  const std::string sealed = token();
  open();
  come(sealed);
  EXPECT_EQ(visitor().place.tour.stop, 1);
  EXPECT_EQ(visitor().place.tour.state, TourRide::State::playing);
  EXPECT_TRUE(told("error").empty());
}

TEST_F(ComeBack, FollowersWaitForALeaderWhoComesBack) {
  join(32, 32);
  join(32, 32);
  order(R"({"type":"group","action":"lead"})", 0);
  const std::string code = last("group", 0)["code"];
  order(R"({"type":"group","action":"follow","code":")" + code + R"("})", 1);
  run(2.5);
  const std::string sealed = token(0);
  break_line(0);
  EXPECT_EQ(show->visits.visitors.front().group.follows, code);
  const size_t leader = come(sealed);
  order(R"({"type":"viewpoint","seq":1,"name":"corner"})", leader);
  EXPECT_EQ(last("state", 1)["position"], last("state", leader)["position"]);
  break_line(leader);
  run(kept_seconds + 1);
  EXPECT_EQ(last("group", 1)["role"], "none");
}

TEST_F(ComeBack, TextsThatAreNotOursChangeNothing) {
  begin_visit();
  const std::string sealed = token();
  std::string broken = sealed;
  broken[5] ^= 1;
  const std::string elsewhere = show->visits.seal->close(R"({"exhibit":"other","day":100})");
  std::vector<std::string> texts = {"x", broken, elsewhere};
  for (const char* text :
       {"{", "[1]", R"({"exhibit":1,"day":100,"id":"1"})", R"({"exhibit":"tiny","id":"1"})",
        R"({"exhibit":"tiny","day":"100","id":"1"})", R"({"exhibit":"tiny","day":100,"id":1})",
        R"({"exhibit":"tiny","day":-9223372036854775808,"id":"1"})"})
    texts.push_back(show->visits.seal->close(text));
  for (const std::string& text : texts) {
    const size_t number = come(text);
    EXPECT_EQ(last("welcome", number)["resumed"], false) << text;
    EXPECT_NE(last("state", number)["viewpoint"], "corner");
  }
  open(100 + token_days + 1);
  EXPECT_EQ(last("welcome", come(sealed))["resumed"], false) << "too old";
  const size_t odd =
      come(show->visits.seal->close(R"({"exhibit":"tiny","day":108,"id":"1","place":[1]})"));
  EXPECT_EQ(last("welcome", odd)["resumed"], true);
  EXPECT_FALSE(told("state", odd).empty());
}

TEST_F(ComeBack, NumbersThatNoPlaceHasAreBounded) {
  const size_t number = come(show->visits.seal->close(
      R"({"exhibit":"tiny","day":100,"id":"1","place":[1e300,-1e300,0,1e300,-1e300,1e300],)"
      R"("viewpoint":-7,"tour":{"id":"round","stop":1e300,"paused":true}})"));
  EXPECT_EQ(last("welcome", number)["resumed"], true);
  const Viewpoint& view = visitor().place.view;
  for (double value : {view.position.x, view.position.y, view.position.z, double(view.yaw),
                       double(view.pitch), double(view.fov)})
    EXPECT_TRUE(std::isfinite(value));
  EXPECT_LT(view.fov, 3.1f);
  EXPECT_EQ(visitor().place.tour.stop, 1);
  EXPECT_FALSE(told("state", number).empty());
}

TEST_F(ComeBack, FewAreKeptAndWhatDidNotChangeIsNotToldAgain) {
  for (size_t i = 0; i < most_kept + 2; i++) join(32, 32);
  run(2.5);
  const size_t told_before = told("keep").size();
  run(5);
  EXPECT_EQ(told("keep").size(), told_before);
  order(R"({"type":"viewpoint","seq":1,"name":"corner"})");
  run(2.5);
  EXPECT_EQ(told("keep").size(), told_before + 1);
  for (size_t i = 0; i < most_kept + 2; i++) break_line(i);
  EXPECT_EQ(show->visits.kept.size(), most_kept);
}

}  // namespace
}  // namespace wellspring::test
