// SPDX-License-Identifier: Apache-2.0
#include "show/answer/walls.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "picture/keyframe.h"
#include "unit/show/show_stage.h"

namespace wellspring::test {
namespace {

using nlohmann::json;

struct Walls : testing::Test, ShowStage {
  void SetUp() override { begin(make_tiny_exhibit(), settings_for("direct", 25)); }
  // A page with a part in the wall; its number.
  size_t open(const json& wall, bool acknowledges = true) {
    const size_t number = connect();
    browsers[number].acknowledges = acknowledges;
    say(json{{"type", "hello"}, {"width", 48}, {"height", 32}, {"wall", wall}}.dump(), number);
    step();
    return number;
  }
  size_t tile(int column, bool acknowledges = true) {
    return open({{"name", "hall"}, {"columns", 2}, {"rows", 1}, {"column", column}, {"row", 0}},
                acknowledges);
  }
  std::vector<const Visitor*> cameras() {
    std::vector<const Visitor*> found;
    for (const Visitor& visitor : show->visits.visitors)
      if (visitor.wall.role == WallRole::camera) found.push_back(&visitor);
    return found;
  }
  std::vector<uint32_t> frames(size_t number) {
    std::vector<uint32_t> all;
    for (const Packet& packet : pictures(number)) all.push_back(read_packet(packet)->header.frame);
    return all;
  }
  bool shows(size_t number, uint32_t frame) {
    for (const json& message : told("show", number))
      if (message["frame"] == frame) return true;
    return false;
  }
  void close(size_t number) { browsers[number].link->mark_closed(); }
};

TEST_F(Walls, TilesGetPartsOfOnePictureUnderOneNumber) {
  tile(0), tile(1);
  ASSERT_EQ(cameras().size(), 1u);
  EXPECT_EQ(cameras()[0]->wants.width, 96);
  run(1);
  for (int i = 0; i < 10; i++) {
    say(json{{"type", "input"}, {"seq", i + 1}, {"look", {0.05, 0}}}.dump(), size_t(i % 2));
    step();
  }
  run(1);
  const std::vector<uint32_t> left = frames(0), right = frames(1);
  ASSERT_GT(right.size(), 10u);
  EXPECT_TRUE(std::equal(right.rbegin(), right.rend() - 1, left.rbegin()))
      << "but for the first, which came before there was a second tile";
  const View view = cameras()[0]->place.last_view;
  EXPECT_NEAR(cameras()[0]->place.view.yaw, 0.5f, 1e-4f) << "both have turned it";
  for (size_t number : {0u, 1u}) {
    const View part = window_view(view, {int(number) * 48, 0, 48, 32});
    EXPECT_LT(mean_difference(last_image(number), truth(part, 64)), 4);
  }
}

TEST_F(Walls, AMomentIsShownWhenAllTilesHaveIt) {
  tile(0), tile(1);
  run(1);
  ASSERT_TRUE(step_until([&] { return shows(0, frames(0).back()); }));
  for (uint32_t frame : frames(1)) EXPECT_TRUE(shows(1, frame)) << "decoded, and shown: " << frame;
  browsers[1].acknowledges = false;
  const size_t before = frames(1).size();
  turn(0.3);
  ASSERT_TRUE(step_until([&] { return frames(1).size() > before; }));
  const uint32_t waits = frames(1)[before];
  EXPECT_EQ(frames(0).back(), waits);
  step(), step();
  EXPECT_FALSE(shows(0, waits)) << "the other tile has not decoded it yet";
  say(json{{"type", "ack"}, {"frame", waits}, {"decoded_ms", 9}}.dump(), 1);
  step();
  EXPECT_TRUE(shows(0, waits));
  EXPECT_TRUE(shows(1, waits));
}

TEST_F(Walls, ATileThatIsLateIsNotWaitedForAndGetsTheLastPicture) {
  tile(0), tile(1);
  run(1);
  browsers[1].acknowledges = false;
  const size_t before = frames(0).size();
  for (int i = 0; i < 100; i++) turn(0.02), step();
  EXPECT_GT(frames(0).size(), before + 20);
  EXPECT_TRUE(step_until([&] { return shows(0, frames(0).back()); }));
  run(1);
  browsers[1].acknowledges = true;
  say(json{{"type", "ack"}, {"frame", frames(1).back()}, {"decoded_ms", 9}}.dump(), 1);
  run(0.5);
  EXPECT_EQ(frames(1).back(), frames(0).back());
}

TEST_F(Walls, ATileThatGoesStopsNobodyAndComesBack) {
  tile(0), tile(1);
  run(0.5);
  say(R"({"type":"input","seq":1,"move":[0,0,1]})", 0);
  step();
  close(0);
  step();
  EXPECT_EQ(cameras()[0]->place.move, vec3(0)) << "nobody holds its keys any more";
  const size_t before = frames(1).size();
  for (int i = 0; i < 10; i++) turn(0.05, 0, 1), step();
  EXPECT_GT(frames(1).size(), before);
  const size_t again = tile(0);
  run(0.5);
  ASSERT_FALSE(frames(again).empty());
  EXPECT_EQ(frames(again).back(), frames(1).back());
  EXPECT_EQ(cameras().size(), 1u);
  close(1), close(again);
  run(0.2);
  EXPECT_TRUE(show->visits.visitors.empty()) << "the camera goes with its last tile";
}

TEST_F(Walls, APageLeadsTheWall) {
  tile(0);
  const size_t page = open({{"name", "hall"}}), other = open({{"name", "yard"}});
  say(R"({"type":"viewpoint","seq":1,"name":"corner"})", page);
  run(0.2);
  const ExhibitViewpoint& corner = show->stage.exhibit.viewpoints[1];
  EXPECT_EQ(cameras()[0]->place.view.position, corner.view.position);
  EXPECT_FALSE(pictures(page).empty()) << "who leads sees it, too";
  say(R"({"type":"viewpoint","seq":1,"name":"door"})", other);
  run(0.2);
  EXPECT_EQ(cameras()[0]->place.view.position, corner.view.position) << "it leads another wall";
  close(page);
  run(0.2);
  say(R"({"type":"viewpoint","seq":1,"name":"door"})", 0);
  run(0.2);
  EXPECT_NE(cameras()[0]->place.view.position, corner.view.position) << "it is the tiles' again";
}

TEST_F(Walls, BeginWhereTheySayAndAreNoVisits) {
  open({{"name", "hall"}, {"column", 0}, {"row", 0}, {"viewpoint", "corner"}});
  run(0.2);
  EXPECT_EQ(cameras()[0]->place.view.position, show->stage.exhibit.viewpoints[1].view.position);
  EXPECT_TRUE(show->sums.empty()) << "no person is counted";
  show->settings.idle_after = 1, show->settings.idle_answer = 0.5;
  run(3);
  EXPECT_EQ(cameras().size(), 1u) << "it does not rest";
}

TEST_F(Walls, AreForTrustedMachines) {
  const size_t stranger = connect();
  browsers[stranger].link->local = false;
  for (const char* wall : {R"({"name":"hall","column":0,"row":0})", R"({"name":"hall"})"}) {
    say(R"({"type":"hello","wall":)" + std::string(wall) + "}", stranger);
    step();
    EXPECT_EQ(last("error", stranger)["code"], "not_trusted");
  }
  const size_t wrong = open({{"name", "hall"}, {"column", 1}, {"row", 0}});
  EXPECT_EQ(last("error", wrong)["code"], "bad_field");
  EXPECT_TRUE(cameras().empty());
}

}  // namespace
}  // namespace wellspring::test
