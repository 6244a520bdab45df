// SPDX-License-Identifier: Apache-2.0
// Ways of a tour's camera: smooth, within their limits, and clear of everything; on easy grounds
// and hard ones.
#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "show/exhibit/load/exhibit_load.h"
#include "show/visit/route.h"
#include "show/visit/tour.h"
#include "unit/show/tiny_exhibit.h"

namespace wellspring::test {
namespace {

// Largest speed, turning and their changes, by differences at 240 a second.
struct Ride {
  double speed = 0, turn = 0, jump = 0, turn_jump = 0, first = 0, last = 0;
};

Ride measure(const CameraPath& path) {
  Ride ride;
  constexpr double dt = 1.0 / 240;
  dvec3 velocity(0);
  double turning = 0;
  Viewpoint before = eval_camera_path(path, 0);
  for (double t = dt; t <= path.seconds + dt; t += dt) {
    Viewpoint now = eval_camera_path(path, t);
    dvec3 v = (now.position - before.position) / dt;
    double w = double(now.yaw - before.yaw) / dt;
    ride.speed = std::max(ride.speed, glm::length(v));
    ride.turn = std::max({ride.turn, std::abs(w), std::abs(double(now.pitch - before.pitch)) / dt});
    ride.jump = std::max(ride.jump, glm::length(v - velocity) / dt);
    ride.turn_jump = std::max(ride.turn_jump, std::abs(w - turning) / dt);
    if (t == dt) ride.first = glm::length(v);
    ride.last = glm::length(v);
    velocity = v;
    turning = w;
    before = now;
  }
  return ride;
}

void expect_comfortable(const CameraPath& path, const std::string& what) {
  CameraLimits limits;
  Ride ride = measure(path);
  EXPECT_LE(ride.speed, 1.01 * double(limits.speed)) << what;
  EXPECT_LE(ride.turn, 1.02 * double(limits.turn)) << what;
  // Velocity does not jump: its change stays bounded however finely it is looked at. Floats of yaw
  // resolve 2e-7 rad, which at 240 a second twice is 0.02 rad/s2.
  EXPECT_LE(ride.jump, 3 * double(limits.acceleration)) << what;
  EXPECT_LE(ride.turn_jump, 3 * double(limits.turn_acceleration) + 0.05) << what;
  EXPECT_LT(ride.first, 0.05) << what << ": begins at rest";
  EXPECT_LT(ride.last, 0.05) << what << ": ends at rest";
}

void expect_ends(const CameraPath& path, const Viewpoint& from, const Viewpoint& to) {
  Viewpoint first = eval_camera_path(path, 0), last = eval_camera_path(path, 1e9);
  EXPECT_LT(glm::length(first.position - from.position), 1e-6);
  EXPECT_LT(glm::length(last.position - to.position), 1e-6);
  EXPECT_NEAR(std::remainder(first.yaw - from.yaw, 2 * pi), 0, 1e-5);
  EXPECT_NEAR(std::remainder(last.yaw - to.yaw, 2 * pi), 0, 1e-5);
  EXPECT_NEAR(last.pitch, to.pitch, 1e-6);
  EXPECT_NEAR(last.fov, to.fov, 1e-6);
}

Viewpoint view(dvec3 position, float yaw, float pitch = 0, float fov = 1) {
  return Viewpoint{.position = position, .yaw = yaw, .pitch = pitch, .fov = fov};
}

TEST(CameraPath, KeepsItsLimitsBetweenAnyTwoViews) {
  Rng rng{11};
  auto random = [&](double reach) { return reach * (2 * double(rng.uniform()) - 1); };
  for (int i = 0; i < 60; i++) {
    Viewpoint from = view({random(8), 1.6, random(8)}, float(random(7)), float(random(1)));
    Viewpoint to =
        view({random(8), 1.6 + random(1), random(8)}, float(random(7)), float(random(1)), 0.5f);
    CameraPath path = make_camera_path({from.position, to.position}, from, to, {});
    expect_comfortable(path, "way " + std::to_string(i));
    expect_ends(path, from, to);
  }
}

TEST(CameraPath, HardLayouts) {
  std::vector<dvec3> zigzag, circle;
  for (int i = 0; i < 12; i++) zigzag.push_back({0.5 * i, 1.6, i % 2 ? 0.8 : 0});
  for (int i = 0; i <= 60; i++) circle.push_back({std::cos(0.1 * i), 1.6, std::sin(0.1 * i)});
  struct Hard {
    const char* what;
    std::vector<dvec3> eyes;
    float yaw_from, yaw_to;
  };
  for (const Hard& hard :
       std::vector<Hard>{{"zigzag", zigzag, 0, 3},
                         {"circle", circle, 3, -3},
                         {"there and back", {{0, 1.6, 0}, {4, 1.6, 0}, {0.1, 1.6, 0.1}}, 0, 3.1f},
                         {"half a turn on the spot", {{1, 1.6, 1}, {1, 1.6, 1}}, -1.5f, 1.6f},
                         {"a millimetre", {{1, 1.6, 1}, {1.001, 1.6, 1}}, 0, 0},
                         {"far from zero", {{1e6, 1.6, -1e6}, {1e6 + 5, 1.6, -1e6}}, 0, 1},
                         {"a kilometre", {{0, 1.6, 0}, {1000, 1.6, 0}}, 0, 1}}) {
    Viewpoint from = view(hard.eyes.front(), hard.yaw_from),
              to = view(hard.eyes.back(), hard.yaw_to, -0.3f);
    CameraPath path = make_camera_path(hard.eyes, from, to, {});
    expect_comfortable(path, hard.what);
    expect_ends(path, from, to);
  }
}

TEST(CameraPath, TakesAtLeastTheTimeItIsGivenAndNoneForNothing) {
  Viewpoint here = view({1, 1.6, 1}, 0.5f), there = view({3, 1.6, 1}, 0.5f);
  EXPECT_NEAR(make_camera_path({here.position, there.position}, here, there, {}, 30).seconds, 30,
              1e-6);
  EXPECT_LT(make_camera_path({here.position, here.position}, here, here, {}).seconds, 0.05);
  double quick = make_camera_path({here.position, there.position}, here, there, {}).seconds;
  EXPECT_GT(quick, 2 / 1.2);
  EXPECT_LT(quick, 6);
}

TEST(CameraPath, LeansAsItsEndsDoAndGoesLongWaysUpright) {
  Viewpoint from = view({0, 1.6, 0}, 0), to = view({8, 1.6, 0}, 0), turned = from;
  from.roll = 0.5f, to.roll = -0.4f, turned.roll = -3;
  CameraPath path = make_camera_path({from.position, to.position}, from, to, {});
  EXPECT_NEAR(eval_camera_path(path, 0).roll, 0.5f, 1e-5f);
  EXPECT_NEAR(eval_camera_path(path, 0.5 * path.seconds).roll, 0, 0.02f);
  EXPECT_NEAR(eval_camera_path(path, path.seconds).roll, -0.4f, 1e-5f);
  CameraPath spin = make_camera_path({from.position, from.position}, from, turned, {});
  EXPECT_NEAR(std::remainder(eval_camera_path(spin, 1e9).roll - turned.roll, 2 * pi), 0, 1e-4f);
  EXPECT_GT(eval_camera_path(spin, 0.5 * spin.seconds).roll, 0.6f) << "the shorter way round";
  for (double t = 0; t < spin.seconds; t += 0.05)
    EXPECT_LT(std::abs(eval_camera_path(spin, t + 0.05).roll - eval_camera_path(spin, t).roll),
              0.05 * 1.02 * double(CameraLimits{}.turn));
}

// ---- ways around things ----

struct Ground {
  Exhibit exhibit;
  std::unique_ptr<World> world;
  WalkMap map;

  explicit Ground(Exhibit made, const std::vector<WalkObstacle>& obstacles = {})
      : exhibit(std::move(made)) {
    world = std::make_unique<World>(exhibit.scene);
    std::vector<vec3> seeds;
    for (const auto& viewpoint : exhibit.viewpoints)
      seeds.push_back(vec3(viewpoint.view.position - exhibit.scene.origin));
    map = make_walk_map(*world, *exhibit.walk, seeds, obstacles);
  }
  // Nearest thing to a body standing at `ground`, by rays in all directions at many heights.
  float nearest(vec3 ground, float reach) const {
    float least = reach;
    for (float height = walk_step + 0.1f; height <= map.eye_height; height += 0.1f)
      for (int i = 0; i < 64; i++) {
        float angle = 2 * pi * float(i) / 64;
        Hit hit = world->intersect(
            {ground + vec3(0, height, 0), 0, {std::cos(angle), 0, std::sin(angle)}, least});
        if (hit.valid()) least = std::min(least, hit.t);
      }
    return least;
  }
};

Mesh& room_of(Exhibit& exhibit) { return exhibit.scene.meshes[0]; }

void expect_clear(const Ground& ground, const Route& route, const std::string& what) {
  ASSERT_FALSE(route.points.empty()) << what << ": " << route.problem;
  float least = 1;
  for (size_t i = 1; i < route.points.size(); i++)
    for (int k = 0; k < 4; k++)
      least = std::min(
          least, ground.nearest(mix(route.points[i - 1], route.points[i], 0.25f * float(k)), 1));
  EXPECT_GE(least, ground.map.radius - 0.02f) << what;
}

TEST(Route, GoesAroundAWall) {
  Ground ground(make_tiny_exhibit());
  vec3 door(-2, 1.6f, 3), corner(3, 1.6f, -3);
  Route route = find_route(ground.map, door, corner);
  expect_clear(ground, route, "wall");
  float length = 0;
  for (size_t i = 1; i < route.points.size(); i++)
    length += glm::length(route.points[i] - route.points[i - 1]);
  // The shortest way passes the wall's end at (1, 0) at arm's length.
  float shortest = glm::length(vec2(-2, 3) - vec2(1, 0)) + glm::length(vec2(1, 0) - vec2(3, -3));
  EXPECT_GT(length, shortest);
  EXPECT_LT(length, 1.2f * shortest);
}

TEST(Route, FindsAGapAndRefusesASlit) {
  for (float gap : {0.9f, 0.4f}) {
    Exhibit exhibit = make_tiny_exhibit();
    add_quad(room_of(exhibit), {1 + gap, 0, 0}, {3, 0, 0}, {0, 4, 0});  // the rest of the wall
    Ground ground(std::move(exhibit));
    Route route = find_route(ground.map, {-2, 1.6f, 3}, {-2, 1.6f, -3});
    if (gap > 0.6f) {
      expect_clear(ground, route, "gap");
    } else {
      EXPECT_TRUE(route.points.empty());
      EXPECT_NE(route.problem.find("no way"), std::string::npos) << route.problem;
      EXPECT_NE(route.problem.find("it ends at"), std::string::npos) << route.problem;
    }
  }
}

TEST(Route, NothingIsTooThin) {
  Exhibit exhibit = make_tiny_exhibit();
  Mesh& room = room_of(exhibit);
  for (int i = 0; i < 24;
       i++) {  // a curtain of threads, 2 mm wide and 0.3 m apart, over the opening
    vec3 foot(1 + 0.13f * float(i), 0.6f, 0);
    add_quad(room, foot, {0.002f, 0, 0}, {0, 0.4f, 0});
  }
  Ground ground(std::move(exhibit));
  EXPECT_TRUE(find_route(ground.map, {-2, 1.6f, 3}, {-2, 1.6f, -3}).points.empty());
}

TEST(Route, UnderWhatHangsHighAndOverWhatLiesLow) {
  Exhibit exhibit = make_tiny_exhibit();
  add_quad(room_of(exhibit), {1, 1.9f, -2}, {3, 0, 0}, {0, 0, 4});      // a gallery above
  add_quad(room_of(exhibit), {1, 0.05f, -1}, {3, 0, 0}, {0, 0.1f, 0});  // a sill
  Ground ground(std::move(exhibit));
  EXPECT_FALSE(find_route(ground.map, {3, 1.6f, 3}, {3, 1.6f, -3}).points.empty());
}

TEST(Route, ClimbsStairsAndSeesSomebodyStandThere) {
  Exhibit exhibit = make_tiny_exhibit();
  Ground free(exhibit), taken(exhibit, {{vec3(2.5f, 0, 0), 0.35f}});
  vec3 from(3, 1.6f, -3), to(3, 1.8f, 3);  // the step of 0.2 m begins at z = 2
  expect_clear(free, find_route(free.map, from, to), "stairs");
  Route around = find_route(taken.map, from, to);
  ASSERT_FALSE(around.points.empty()) << around.problem;
  for (vec3 p : around.points)
    EXPECT_GE(glm::length(vec2(p.x - 2.5f, p.z)), 0.35f + taken.map.radius - 0.02f);
  EXPECT_NEAR(around.points.back().y, 0.2f, 0.01f);
  EXPECT_NEAR(around.points.front().y, 0, 0.01f);
}

TEST(Route, FromNowhereThereIsNone) {
  Ground ground(make_tiny_exhibit());
  for (vec3 nowhere : {vec3(100, 1.6f, 0), vec3(0, 50, 0), vec3(NAN, 0, 0), vec3(1e30f, 1.6f, 0)}) {
    EXPECT_TRUE(find_route(ground.map, nowhere, {3, 1.6f, -3}).points.empty());
    EXPECT_TRUE(find_route(ground.map, {3, 1.6f, -3}, nowhere).points.empty());
  }
}

TEST(Route, TheSceneMayLieFarFromZero) {
  Exhibit exhibit = make_tiny_exhibit(dvec3(1e6, 0, -1e6));
  Ground ground(std::move(exhibit));
  EXPECT_FALSE(find_route(ground.map, {-2, 1.6f, 3}, {3, 1.6f, -3}).points.empty());
}

// The castle's own tours: every leg within the limits, and clear of every wall and case.
TEST(CastleTour, IsComfortableAndClear) {
  std::vector<Problem> problems;
  Exhibit exhibit = read_exhibit(std::string(WELLSPRING_SOURCE) + "/content/castle", problems);
  ASSERT_FALSE(exhibit.tours.empty());
  Ground ground(std::move(exhibit));
  TourRoads roads = make_tour_roads(ground.exhibit, *ground.world, problems);
  for (const Problem& problem : problems) EXPECT_FALSE(problem.fatal) << to_string(problem);
  for (const auto& legs : roads.legs)
    for (size_t i = 1; i < legs.size(); i++) {
      ASSERT_TRUE(legs[i]);
      std::string what = "leg " + std::to_string(i);
      expect_comfortable(*legs[i], what);
      float least = 1;
      dvec3 first = eval_camera_path(*legs[i], 0).position,
            last = eval_camera_path(*legs[i], 1e9).position;
      for (double t = 0; t <= legs[i]->seconds; t += 0.05) {
        Viewpoint at = eval_camera_path(*legs[i], t);
        // Viewpoints themselves may lean over a case.
        if (std::min(glm::length(at.position - first), glm::length(at.position - last)) <
            double(lean))
          continue;
        vec3 eye = vec3(at.position - ground.exhibit.scene.origin);
        least = std::min(least, ground.nearest(eye - vec3(0, ground.map.eye_height, 0), 1));
      }
      EXPECT_GE(least, ground.map.radius - 0.03f) << what;
    }
}

}  // namespace
}  // namespace wellspring::test
