// SPDX-License-Identifier: Apache-2.0
// A ride through a tour: stops in order, text by text, paused, left, looked round in, and played
// on.
#include <gtest/gtest.h>

#include "show/visit/tour.h"
#include "unit/show/tiny_exhibit.h"

namespace wellspring::test {
namespace {

struct TourTest : testing::Test {
  Exhibit exhibit = make_tiny_exhibit();
  std::unique_ptr<World> world;
  TourRoads roads;
  TourRide ride;
  Voice narration;
  std::vector<int> arrivals;
  std::vector<std::string> told;
  bool finished = false;
  double fastest = 0, quickest_turn = 0;
  Viewpoint last;

  void SetUp() override { prepare(); }
  void prepare() {
    world = std::make_unique<World>(exhibit.scene);
    std::vector<Problem> problems;
    roads = make_tour_roads(exhibit, *world, problems);
    ASSERT_TRUE(problems.empty()) << to_string(problems.front());
    last = exhibit.viewpoints[0].view;
  }
  void play() { start_tour(ride, narration, 0, exhibit, roads, last); }
  void run(double seconds, float dt = 0.02f) {
    for (double t = 0; t < seconds && !finished; t += double(dt)) {
      VoiceEvents said = advance_voice(narration, dt);
      if (said.begun) told.push_back(said.begun->line.at("en").text);
      for (const ActionEvent& act : said.acts)
        if (act.kind == StoryMarkKind::view)
          glide_to(ride, find_viewpoint(exhibit, act.name), last);
      TourStep step = advance_tour(ride, narration, exhibit, roads, dt);
      if (step.arrived >= 0) arrivals.push_back(step.arrived);
      finished = step.finished;
      fastest = std::max(fastest, glm::length(step.view.position - last.position) / double(dt));
      quickest_turn = std::max(
          quickest_turn,
          std::abs(std::remainder(double(step.view.yaw - last.yaw), 2 * double(pi))) / double(dt));
      last = step.view;
    }
  }
};

TEST_F(TourTest, VisitsItsStopsTellsTheirTextsAndEnds) {
  play();
  run(100);
  EXPECT_TRUE(finished);
  EXPECT_EQ(arrivals, (std::vector<int>{0, 1}));
  EXPECT_EQ(told, (std::vector<std::string>{"Here"}));
  EXPECT_LT(glm::length(last.position - exhibit.viewpoints[1].view.position), 1e-6);
  EXPECT_LE(fastest, 1.01 * double(CameraLimits{}.speed));
  EXPECT_LE(quickest_turn, 1.01 * double(CameraLimits{}.turn));
}

TEST_F(TourTest, LeavesAStopWhenItsTextHasEnded) {
  exhibit.tours[0].stops[0].text["en"][0].text = std::string(200, 'x');  // 12.9 s to read
  play();
  run(12.5);
  EXPECT_LT(glm::length(last.position - exhibit.viewpoints[0].view.position), 1e-6);
  run(3);
  EXPECT_GT(glm::length(last.position - exhibit.viewpoints[0].view.position), 0.1);
}

TEST_F(TourTest, TextOnTheWayIsToldOnTheWayAndEndsBeforeTheNext) {
  exhibit.tours[0].stops[1].way_text["en"].emplace_back().text = "On the way.";
  exhibit.tours[0].stops[1].text["en"].emplace_back().text = "There.";
  play();
  run(3.5);
  EXPECT_EQ(told, (std::vector<std::string>{"Here", "On the way."}));
  EXPECT_EQ(arrivals, std::vector<int>{0});
  run(100);
  EXPECT_EQ(told.back(), "There.");
}

TEST_F(TourTest, MarksOfTheTextMoveTheCamera) {
  exhibit.tours[0].stops.resize(1);
  exhibit.tours[0].stops[0].text["en"] =
      read_story("Look at <view name='corner'/>that corner, and back.", "a").lines;
  prepare();
  play();
  run(100);
  EXPECT_TRUE(finished);
  EXPECT_LT(glm::length(last.position - exhibit.viewpoints[1].view.position), 1e-6);
}

TEST_F(TourTest, PauseComesToRestSoftlyAndHoldsThePlaceAndTheText) {
  play();
  run(6);  // on the way
  Viewpoint before = last;
  pause_tour(ride, narration);
  EXPECT_TRUE(narration.paused);
  run(3);
  EXPECT_GT(glm::length(last.position - before.position), 0.05) << "not like a wall";
  EXPECT_LT(glm::length(last.position - before.position), 1.2);
  dvec3 here = last.position;
  run(50);
  EXPECT_EQ(last.position, here);
  play();
  EXPECT_FALSE(narration.paused);
  run(100);
  EXPECT_TRUE(finished);
  EXPECT_EQ(arrivals, (std::vector<int>{0, 1}));
  EXPECT_LE(fastest, 1.01 * double(CameraLimits{}.speed));
}

TEST_F(TourTest, WhereItLeapsItIsAtOnceAtItsStopsAndTellsAllTheSame) {
  exhibit.tours[0].stops[1].way_text["en"].emplace_back().text = "On the way.";
  play();
  ride.leaps = true;  // the visitor's setting, taken with every step
  bool between = false;
  const dvec3 ends[2] = {exhibit.viewpoints[0].view.position, exhibit.viewpoints[1].view.position};
  for (int i = 0; i < 2000 && !finished; i++) {
    run(0.02);
    between |=
        glm::length(last.position - ends[0]) > 1e-6 && glm::length(last.position - ends[1]) > 1e-6;
  }
  EXPECT_TRUE(finished);
  EXPECT_FALSE(between);
  EXPECT_EQ(arrivals, (std::vector<int>{0, 1}));
  EXPECT_EQ(told, (std::vector<std::string>{"Here", "On the way."}));
}

// Slower pictures: the same way in more time, softly, and at its own pace afterwards.
TEST_F(TourTest, WaitsForPictures) {
  glide_to(ride, 1, last);
  run(0.1);
  ASSERT_TRUE(ride.path);
  double way = ride.path->seconds;
  ride.time = 0;
  EXPECT_EQ(turn_ahead(*ride.path, 0, 0), 0);
  EXPECT_NEAR(turn_ahead(*ride.path, 0, way), 2,
              0.3);  // and keeps to a way around what stands there
  ride.most_pace = 0.25f;
  run(2);
  EXPECT_EQ(ride.pace, 0.25f);
  double before = ride.time;
  run(0.4);
  EXPECT_NEAR(ride.time - before, 0.1, 0.01);
  ride.most_pace = 1;
  run(2);
  EXPECT_EQ(ride.pace, 1);
}

TEST_F(TourTest, WhoHasWalkedOffIsFetched) {
  play();
  run(6);
  pause_tour(ride, narration);
  run(3);
  last.position = exhibit.viewpoints[0].view.position + dvec3(0.5, 0, 0.3);
  last.yaw = 2;
  fastest = 0;
  play();
  run(100);
  EXPECT_TRUE(finished);
  EXPECT_LT(glm::length(last.position - exhibit.viewpoints[1].view.position), 1e-6);
  EXPECT_LE(fastest, 1.01 * double(CameraLimits{}.speed)) << "no jump";
}

TEST_F(TourTest, WhoStandsWhereNoWayLeadsIsPutThere) {
  last.position = {0, 100, 0};
  play();
  run(0.1);
  EXPECT_EQ(last.position, exhibit.viewpoints[0].view.position);
}

TEST_F(TourTest, LookingRoundDoesNotStopItAndEasesBack) {
  play();
  run(5);
  TourRide other = ride;
  Voice other_voice = narration;
  look_round(ride, {0.8f, -0.2f});
  Viewpoint turned = advance_tour(ride, narration, exhibit, roads, 0.02f).view;
  Viewpoint plain = advance_tour(other, other_voice, exhibit, roads, 0.02f).view;
  EXPECT_EQ(turned.position, plain.position);
  EXPECT_NEAR(turned.yaw - plain.yaw, 0.8, 1e-3);
  EXPECT_NEAR(turned.pitch - plain.pitch, -0.2, 1e-3);
  last = turned;
  quickest_turn = 0;
  run(1);
  EXPECT_NEAR(ride.look.x, 0.8, 1e-5) << "it waits a while";
  float before = ride.look.x;
  for (int i = 0; i < 300; i++) {
    advance_tour(ride, narration, exhibit, roads, 0.02f);
    EXPECT_LE(before - ride.look.x, double(CameraLimits{}.turn) * 0.02 * 1.001);
    before = ride.look.x;
  }
  EXPECT_LT(glm::length(ride.look), 0.02f);
  look_round(ride, {100, 100});
  EXPECT_LE(glm::length(ride.look), 3.0f);
}

TEST_F(TourTest, AWayThatCannotBeGoneIsAProblemWithItsStop) {
  add_quad(exhibit.scene.meshes[0], {1, 0, 0}, {3, 0, 0}, {0, 4, 0});  // closes the wall
  world = std::make_unique<World>(exhibit.scene);
  std::vector<Problem> problems;
  roads = make_tour_roads(exhibit, *world, problems);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].where, "/tours/0/stops/1");
  EXPECT_TRUE(problems[0].fatal);
  EXPECT_NE(problems[0].what.find("no way"), std::string::npos);
}

TEST_F(TourTest, WhereVisitorsFlyWaysAreStraight) {
  exhibit.walk.reset();
  prepare();
  EXPECT_FALSE(roads.map);
  play();
  run(100);
  EXPECT_TRUE(finished);
}

TEST_F(TourTest, AnExhibitWithoutToursIsMappedForThoseWhoPoint) {
  exhibit.tours.clear();
  prepare();
  ASSERT_TRUE(roads.map);
  EXPECT_FALSE(roads.map->places.empty());
}

}  // namespace
}  // namespace wellspring::test
