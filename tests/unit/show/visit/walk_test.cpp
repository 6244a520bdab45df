// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "show/visit/walk_map.h"
#include "unit/show/tiny_exhibit.h"

namespace wellspring::test {
namespace {

struct Walk : testing::TestWithParam<double> {
  dvec3 origin = dvec3(GetParam(), 0, -GetParam());
  Exhibit exhibit = make_tiny_exhibit(origin);
  World world{exhibit.scene};
  dvec3 go(dvec3 from, vec3 velocity, float seconds, float dt = 0.02f) {
    dvec3 position = origin + from;
    for (float t = 0; t < seconds; t += dt)
      position = walk(world, exhibit.walk, position, velocity, dt);
    return position - origin;
  }
};

TEST(KeepDistance, NobodyComesNearerThanTheInnermostWall) {
  const dvec3 centre(100, 0, -50);
  // The visitor comes from everywhere, in steps of any length, straight at it and past it.
  for (double length : {0.01, 0.1, 0.5, 5.0})
    for (int i = 0; i < 64; i++) {
      double angle = i * 0.0981747704;
      dvec3 at = centre + dvec3(2 * std::cos(angle), 1.6, 2 * std::sin(angle));
      dvec3 aim = centre + dvec3(0.3 * std::sin(3 * angle), 1.6, 0.2);
      for (int step = 0; step < 400; step++) {
        dvec3 way = aim - at;
        way.y = 0;
        dvec3 next = keep_distance(
            at, at + way * std::min(1.0, length / std::max(glm::length(way), 1e-6)), centre);
        at = next;
        ASSERT_GE(std::hypot(at.x - centre.x, at.z - centre.z), nearest_to_storyteller - 1e-6);
      }
    }
}

TEST(KeepDistance, OneSlidesRoundAndGoesAway) {
  dvec3 at(0, 1.6, 2);
  double least = 9;
  for (int i = 0; i < 400; i++) {
    at = keep_distance(at, at + dvec3(0.004, 0, -0.02), dvec3(0));
    least = std::min(least, std::hypot(at.x, at.z));
  }
  EXPECT_LT(at.z, -2) << "past it, not stuck before it";
  EXPECT_NEAR(least, nearest_to_storyteller, 0.02);
  // A visitor who stands within (a viewpoint there, a storyteller that has just come) may leave,
  // not go farther in.
  dvec3 within(0.4, 1.6, 0);
  EXPECT_NEAR(keep_distance(within, {0.2, 1.6, 0}, dvec3(0)).x, 0.4, 1e-9);
  EXPECT_EQ(keep_distance(within, {0.6, 1.7, 0}, dvec3(0)), dvec3(0.6, 1.7, 0));
  EXPECT_EQ(keep_distance({0, 1.6, 5}, {0, 1.6, 4}, dvec3(0)), dvec3(0, 1.6, 4));
}

TEST_P(Walk, ViewpointsWithoutGroundAreNamed) {
  exhibit.folder = "content/tiny";
  const dvec3 more[] = {{0, 5.5, 3}, {0, 5.7, 3}, {6, 1.6, 0}, {0, -1, 0}, {3, 1.8, 3}};
  for (dvec3 position : more) {
    exhibit.viewpoints.push_back(exhibit.viewpoints[0]);
    exhibit.viewpoints.back().view.position = origin + position;
    exhibit.viewpoints.back().where = "/viewpoints/" + std::to_string(exhibit.viewpoints.size());
  }
  exhibit.viewpoints[4].view.name = "outside";
  exhibit.viewpoints[5].where.clear();
  // The second of these is too high above the ceiling, one can climb down from the first.
  for (size_t i = 2; i < 4; i++) exhibit.viewpoints[i].view.position.y += 4;
  std::vector<Problem> problems;
  check_ground(exhibit, world, problems);
  ASSERT_EQ(problems.size(), 3u);
  const char* places[] = {"/viewpoints/4/position", "/viewpoints/5/position", "/scene"};
  for (size_t i = 0; i < 3; i++) {
    EXPECT_EQ(problems[i].file, "content/tiny/exhibit.json");
    EXPECT_EQ(problems[i].where, places[i]);
    EXPECT_FALSE(problems[i].fatal) << "whoever only looks from there may";
  }
  EXPECT_NE(problems[1].what.find("5.6 m under viewpoint 'outside'"), std::string::npos)
      << problems[1].what;
  // Walking says the same.
  for (int i = 0; i < int(exhibit.viewpoints.size()); i++) {
    dvec3 from = exhibit.viewpoints[size_t(i)].view.position,
          to = walk(world, exhibit.walk, from, {0.5f, 0, 0}, 0.1f);
    EXPECT_EQ(to.x == from.x, i >= 3 && i <= 5) << i;
  }
  exhibit.walk.reset();  // who flies needs none
  problems.clear();
  check_ground(exhibit, world, problems);
  EXPECT_TRUE(problems.empty());
}

TEST_P(Walk, StraightOverFreeFloor) {
  dvec3 end = go({-2, 1.6, 3}, {0, 0, -1}, 1.5f);
  EXPECT_NEAR(end.z, 1.5, 0.05);
  EXPECT_NEAR(end.x, -2, 1e-3);
  EXPECT_NEAR(end.y, 1.6, 1e-3);
}

TEST_P(Walk, StopsBeforeAWallAndKeepsItsDistance) {
  dvec3 end = go({-2, 1.6, 3}, {0, 0, -1.4f}, 10);
  EXPECT_GT(end.z, 0.2);
  EXPECT_LT(end.z, 0.4);
}

TEST_P(Walk, SlidesAlongAWall) {
  dvec3 end = go({-3, 1.6, 1}, {1, 0, -1}, 3);
  EXPECT_GT(end.x, -1);
  EXPECT_GT(end.z, 0.2);
}

TEST_P(Walk, GoesThroughTheOpening) {
  dvec3 end = go({2.5, 1.6, 1}, {0, 0, -1.4f}, 2);
  EXPECT_LT(end.z, -1.2);
}

TEST_P(Walk, ClimbsAStepAndComesDownAgain) {
  dvec3 up = go({3, 1.6, 1}, {0, 0, 1}, 2);
  EXPECT_GT(up.z, 2.5);
  EXPECT_NEAR(up.y, 1.8, 0.02);
  dvec3 down = go(up, {0, 0, -1}, 2);
  EXPECT_NEAR(down.y, 1.6, 0.02);
}

TEST_P(Walk, NeverLeavesTheRoomWhateverTheStep) {
  for (float dt : {1e-6f, 0.01f, 0.25f, 5.0f})
    for (int angle = 0; angle < 16; angle++) {
      float a = float(angle) * pi / 8;
      dvec3 end =
          go({-2, 1.6, 2}, 20.0f * vec3(std::cos(a), 0, std::sin(a)), std::min(1.0f, 200 * dt), dt);
      EXPECT_LT(std::abs(end.x), 4);
      EXPECT_LT(std::abs(end.z), 4);
      EXPECT_GT(end.y, 1);
    }
}

TEST_P(Walk, NonsenseVelocityMovesNobody) {
  dvec3 from = origin + dvec3(-2, 1.6, 3);
  EXPECT_EQ(walk(world, exhibit.walk, from, vec3(NAN, 0, 0), 0.02f), from);
  EXPECT_EQ(walk(world, exhibit.walk, from, vec3(0, 0, INFINITY), 0.02f), from);
}

TEST_P(Walk, BoundsHold) {
  exhibit.walk->bounds = Bounds{vec3(origin + dvec3(-3, 0, 1)), vec3(origin + dvec3(-1, 3, 3.5))};
  EXPECT_GE(go({-2, 1.6, 3}, {-1, 0, 0}, 5).x, -3.01 - std::abs(GetParam()) * 1e-7);
}

INSTANTIATE_TEST_SUITE_P(NearAndFar, Walk, testing::Values(0.0, 1e6));

TEST(WalkFree, WithoutRulesAVisitorFlies) {
  Exhibit exhibit = make_tiny_exhibit();
  World world(exhibit.scene);
  dvec3 end = walk(world, {}, dvec3(0, 1, 0), vec3(0, 2, 0), 0.1f);
  EXPECT_NEAR(end.y, 1.2, 1e-6);
}

TEST(MoveDirection, FollowsTheYaw) {
  vec3 ahead = move_direction({0, 0, 1}, 0), left = move_direction({0, 0, 1}, pi / 2);
  EXPECT_NEAR(ahead.z, -1, 1e-6);
  EXPECT_NEAR(left.x, -1, 1e-6);
  vec3 right = move_direction({1, 0, 0}, pi / 2);
  EXPECT_NEAR(right.z, -1, 1e-6);
}

}  // namespace
}  // namespace wellspring::test
