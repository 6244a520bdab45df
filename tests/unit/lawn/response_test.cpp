// SPDX-License-Identifier: Apache-2.0
#include "lawn/response.h"

#include <gtest/gtest.h>

#include <oneapi/tbb/global_control.h>

#include "base/rng.h"
#include "made.h"

namespace wellspring::test {
namespace {

constexpr float epsilon = 1e-4f;  // metres
const Wind breeze;

// Holds a meadow in which something happens.
struct Meadow {
  Lawn lawn;
  LawnState state;

  explicit Meadow(const LawnDescription& description = small_meadow())
      : lawn(make_lawn(description)), state(make_lawn_state(lawn)) {}
  void step(double time, const Walkers& walkers = {}) {
    step_lawn(state, lawn, breeze, walkers, time);
  }
  std::vector<vec3> joints_now() const { return all_joints(lawn, state, breeze); }
  // Returns the joints that wind alone would give.
  std::vector<vec3> joints_of_wind() const {
    LawnState fresh = make_lawn_state(lawn);
    fresh.time = state.time;
    return all_joints(lawn, fresh, breeze);
  }
  float bent_by() const { return farthest(joints_now(), joints_of_wind()); }
};

// Returns two legs that have walked for `time`.
Walkers legs(double time) {
  Walkers walkers;
  for (const float side : {-0.1f, 0.1f}) {
    const vec3 foot(side, 0.05f, -1 + 1.2f * float(time));
    walkers.capsules.push_back({foot - vec3(0, 0, 0.1f), foot + vec3(0, 0, 0.1f), 0.07f});
    walkers.capsules.push_back({foot, foot + vec3(0, 0.9f, 0.05f), 0.09f});
  }
  return walkers;
}

TEST(Response, NoJointIsInsideAWalkerAndRootsStay) {
  MadeMesh boots;
  add_box(boots, {-0.15f, 0, -0.2f}, {0.15f, 0.1f, 0.2f});
  add_box(boots, {-0.1f, 0, -0.2f}, {0.1f, 0.6f, 0});
  const DepthCube cube(boots.places, boots.triangles);
  const MadeMesh sphere = made_sphere(0.2f, 48);
  const DepthCube ball_cube(sphere.places, sphere.triangles);
  Meadow meadow;
  for (int i = 1; i < 90; i++) {
    Walkers walkers = legs(i / 60.0);
    const float way = 0.02f * float(i);
    const mat3 turn(glm::rotate(mat4(1), way, vec3(0, 1, 0)));
    walkers.cubes = {{&cube, {-1 + way, 0, 0.5f}, turn}, {&ball_cube, {0.4f, 0.15f, -1 + way}}};
    meadow.step(i / 60.0, walkers);
    ASSERT_LE(deepest(meadow.lawn, meadow.state, breeze, walkers), epsilon) << i;
    EXPECT_GT(meadow.bent_by(), 0.05f);
  }
  for_blades(meadow.lawn, meadow.state, breeze,
             [&](int, int blade, const BladeShapes& shapes, int lane) {
               const size_t k = size_t(blade);
               EXPECT_EQ(shapes.joint[0].at(lane),
                         vec3(meadow.lawn.x[k], meadow.lawn.y[k], meadow.lawn.z[k]));
             });
}

TEST(Response, WalkersWhoOverlapPushNobodyIntoEachOther) {
  Meadow meadow;
  Walkers walkers;
  for (int i = 0; i < 12; i++) {
    const vec3 at(0.15f * float(i % 4), 0.05f, 0.15f * float(i / 4));
    walkers.capsules.push_back({at, at + vec3(0, 0.2f, 0), 0.12f});
  }
  meadow.step(1, walkers);
  EXPECT_LE(deepest(meadow.lawn, meadow.state, breeze, walkers), epsilon);
}

double stretch_energy(const BladeShapes& shapes, const BladeShapes& rest, int lane) {
  double sum = 0;
  for (int over = 1; over <= 2; over++)
    for (int k = 0; k + over < joints; k++) {
      const float wanted = glm::length(rest.joint[k].at(lane) - rest.joint[k + over].at(lane));
      const double off =
          glm::length(shapes.joint[k].at(lane) - shapes.joint[k + over].at(lane)) - wanted;
      sum += (over == 1 ? 1 : 0.25) * off * off;
    }
  return sum;
}

TEST(Springs, EnergyFallsWithEachIterationAndLengthComesBack) {
  const Lawn lawn = make_lawn(small_meadow());
  const WindNow wind(breeze, 3);
  Rng random(4);
  for (const float stiffness : {0.1f, 0.5f, 0.8f, 1.0f})
    for (int tile = 0; tile < int(lawn.tile.size()); tile++) {
      const BladeShapes rest = eval_wind_shapes(lawn, lawn.tile[size_t(tile)].begin, wind);
      BladeShapes shapes = rest;
      for (int k = 1; k < joints; k++)
        for (int lane = 0; lane < lane_count; lane++)
          shapes.joint[k].set(
              lane,
              shapes.joint[k].at(lane) +
                  0.05f * (vec3(random.uniform(), random.uniform(), random.uniform()) - 0.5f));
      double before[lane_count];  // square metres; rounding of places changes some 1e-11
      for (int lane = 0; lane < lane_count; lane++)
        before[lane] = stretch_energy(shapes, rest, lane);
      for (int i = 0; i < int(300 / stiffness); i++) {
        relax_springs(shapes, rest, LaneMask{} - 1, stiffness);
        for (int lane = 0; lane < lane_count; lane++) {
          const double now = stretch_energy(shapes, rest, lane);
          EXPECT_LE(now, before[lane] + 1e-10) << stiffness << ' ' << i;
          before[lane] = now;
        }
      }
      for (int lane = 0; lane < lane_count; lane++) {
        EXPECT_EQ(shapes.joint[0].at(lane), rest.joint[0].at(lane));
        for (int k = 0; k < segments; k++) {
          const vec3 line = shapes.joint[k + 1].at(lane) - shapes.joint[k].at(lane);
          EXPECT_NEAR(glm::length(line) / rest.length[lane], 1, 0.02f);
        }
      }
    }
}

TEST(Springs, OtherLanesAndNoStiffnessChangeNothing) {
  const Lawn lawn = make_lawn(small_meadow());
  const BladeShapes rest = eval_wind_shapes(lawn, 0, WindNow(breeze, 0));
  BladeShapes shapes = rest;
  shapes.joint[2].x += 0.1f;
  const BladeShapes before = shapes;
  relax_springs(shapes, rest, LaneMask{} - 1, 0);
  relax_springs(shapes, rest, LaneMask{}, 1);
  for (int k = 0; k < joints; k++)
    for (int lane = 0; lane < lane_count; lane++)
      EXPECT_EQ(shapes.joint[k].at(lane), before.joint[k].at(lane));
}

TEST(Recovery, EndsExactlyInTheWind) {
  Meadow meadow;
  meadow.step(1, ball({0, 0.1f, 0}, 0.3f));
  const double end = 1 + meadow.state.settings.lie + meadow.state.settings.rise;
  meadow.step(end - 0.01);
  EXPECT_FALSE(meadow.state.active.empty());
  EXPECT_LT(meadow.bent_by(), 1e-4f);  // it arrives there without a jump
  meadow.step(end);
  EXPECT_EQ(meadow.joints_now(), meadow.joints_of_wind());
  EXPECT_TRUE(meadow.state.active.empty());
  for (const BentTile& bent : meadow.state.bent) EXPECT_EQ(bent.joint.capacity(), 0u);
}

TEST(Recovery, IsTheSameAtAnyRate) {
  Meadow fast, slow;
  const Walkers walkers = ball({0.3f, 0.15f, 0.2f}, 0.25f);
  fast.step(1, walkers), slow.step(1, walkers);
  for (int i = 1; i <= 60; i++) {
    for (int k = 1; k <= 6; k++) fast.step(1 + (6 * (i - 1) + k) / 60.0);
    slow.step(1 + i / 10.0);
    EXPECT_LT(farthest(fast.joints_now(), slow.joints_now()), 1e-5f) << i;
  }
}

TEST(Recovery, LengthIsKeptAllTheWay) {
  Meadow meadow;
  for (int i = 0; i < 60; i++) meadow.step(i / 60.0, legs(i / 60.0));
  for (double time = 1 + meadow.state.settings.settle; time < 7; time += 0.25) {
    meadow.step(time);
    for_blades(meadow.lawn, meadow.state, breeze,
               [&](int, int blade, const BladeShapes& shapes, int lane) {
                 for (int k = 0; k < segments; k++)
                   EXPECT_NEAR(glm::length(shapes.joint[k + 1].at(lane) - shapes.joint[k].at(lane)),
                               meadow.lawn.length[size_t(blade)] / segments, 1e-5f);
               });
  }
}

TEST(Recovery, TrailIsSeenForItsTime) {
  Meadow meadow;
  for (int i = 0; i <= 90; i++) meadow.step(i / 60.0, legs(i / 60.0));
  // Joints that have been bent, and how far, around the place where the walk began.
  const auto trail = [&] {
    const std::vector<vec3> now = meadow.joints_now(), wind = meadow.joints_of_wind();
    float most = 0;
    for (size_t i = 0; i < now.size(); i++)
      if (std::abs(now[i].x) < 0.4f && now[i].z > -0.9f && now[i].z < 0.5f)
        most = std::max(most, glm::length(now[i] - wind[i]));
    return most;
  };
  const float first = trail();
  EXPECT_GT(first, 0.08f);
  const float lie = meadow.state.settings.lie, rise = meadow.state.settings.rise;
  meadow.step(1.25 + lie);  // the middle was touched at 0.6 s and later
  EXPECT_GT(trail(), 0.5f * first);
  meadow.step(1.5 + lie + 0.5 * rise);
  EXPECT_GT(trail(), 0.02f * first);
  EXPECT_LT(trail(), 0.5f * first);
  meadow.step(1.5 + lie + rise);
  EXPECT_EQ(trail(), 0);
}

TEST(Tiles, OnlyThoseTouchedChange) {
  Meadow meadow;
  const vec3 at(0.2f, 0.1f, -0.4f);
  meadow.step(1, ball(at, 0.2f));
  EXPECT_EQ(meadow.state.time, 1);
  EXPECT_FALSE(meadow.state.active.empty());
  EXPECT_LT(meadow.state.active.size(), 10u);
  const std::vector<vec3> now = meadow.joints_now(), wind = meadow.joints_of_wind();
  size_t i = 0;
  for_blades(meadow.lawn, meadow.state, breeze, [&](int tile, int, const BladeShapes&, int) {
    const bool active = meadow.state.state[size_t(tile)] != TileState::idle;
    for (int k = 0; k < joints; k++, i++)
      if (!active) {
        EXPECT_EQ(now[i], wind[i]);
      }
  });
  for (size_t t = 0; t < meadow.lawn.tile.size(); t++) {
    const bool active = std::ranges::count(meadow.state.active, int(t)) == 1;
    EXPECT_EQ(meadow.state.state[t] != TileState::idle, active);
    if (!active) {
      EXPECT_EQ(meadow.state.bent[t].joint.capacity(), 0u);
    }
  }
}

TEST(Tiles, GoFromIdleOverCollidingAndRecoveringToIdle) {
  Meadow meadow;
  const auto count = [&](TileState state) { return std::ranges::count(meadow.state.state, state); };
  const int64_t all = int64_t(meadow.lawn.tile.size());
  EXPECT_EQ(count(TileState::idle), all);
  meadow.step(1, ball({0, 0.1f, 0}, 0.2f));
  const int64_t met = count(TileState::colliding);
  EXPECT_GT(met, 0);
  meadow.step(1.1, ball({1.5f, 0.1f, 1.5f}, 0.2f));
  EXPECT_GT(count(TileState::colliding), 0);
  EXPECT_GT(count(TileState::recovering), 0);
  EXPECT_LE(count(TileState::recovering), met);
  meadow.step(20);
  EXPECT_EQ(count(TileState::idle), all);
  // Who is only near a tile bends nothing, and nothing recovers.
  meadow.step(21, ball({2.45f, 0.1f, 2.45f}, 0.4f));
  EXPECT_GT(count(TileState::colliding), 0);
  meadow.step(21.1);
  EXPECT_EQ(count(TileState::idle), all);
}

TEST(Response, IsTheSameForAnyNumberOfThreads) {
  Meadow many, one;
  for (int i = 1; i < 40; i++) many.step(i / 30.0, legs(i / 30.0));
  {
    oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, 1);
    for (int i = 1; i < 40; i++) one.step(i / 30.0, legs(i / 30.0));
  }
  EXPECT_EQ(many.joints_now(), one.joints_now());
  EXPECT_EQ(many.state.active, one.state.active);
}

TEST(Hard, WalkersThatAreNoneTouchNothing) {
  Meadow meadow;
  Walkers walkers = ball({0, 0, 0}, 0);
  walkers.capsules.push_back({vec3(NAN), vec3(0), 0.2f});
  walkers.capsules.push_back({vec3(0), vec3(0), INFINITY});
  walkers.cubes.push_back({});
  meadow.step(1, walkers);
  EXPECT_TRUE(meadow.state.active.empty());
  EXPECT_EQ(meadow.joints_now(), meadow.joints_of_wind());
}

TEST(Hard, SphereOfAKilometreLeavesNobodyInside) {
  Meadow meadow;
  const Walkers huge = ball({30, -900, 10}, 1000);
  meadow.step(1, huge);
  EXPECT_LE(deepest(meadow.lawn, meadow.state, breeze, huge), 1e-3f);
  for (const vec3& joint : meadow.joints_now()) ASSERT_TRUE(is_finite(joint));
  meadow.step(30);
  EXPECT_EQ(meadow.joints_now(), meadow.joints_of_wind());
}

TEST(Hard, BladesOfNoHeightOneBladeAndNone) {
  LawnDescription flat = small_meadow(), one = flat, none = flat;
  flat.height = 0;
  one.density = 1 / 16.0f, one.seed = 3;
  none.extent.constant = vec3(0);
  for (const LawnDescription& description : {flat, one, none}) {
    Meadow meadow(description);
    for (int i = 1; i < 20; i++) {
      meadow.step(i, ball({0, 0.1f, 0}, 2));
      EXPECT_LE(meadow.lawn.tallest == 0
                    ? 0
                    : deepest(meadow.lawn, meadow.state, breeze, ball({0, 0.1f, 0}, 2)),
                epsilon);
      for (const vec3& joint : meadow.joints_now()) ASSERT_TRUE(is_finite(joint));
    }
    meadow.step(40);
    EXPECT_EQ(meadow.joints_now(), meadow.joints_of_wind());
  }
}

TEST(Hard, HoursAreAsGoodAsSeconds) {
  Meadow early, late;
  const Walkers walkers = ball({0, 0.12f, 0}, 0.25f);
  // Somebody stands there for five minutes.
  for (int i = 0; i < 300; i++) late.step(1e6 + i, walkers);
  late.step(1e6 + 300, walkers);
  EXPECT_LE(deepest(late.lawn, late.state, breeze, walkers), epsilon);
  early.step(1, walkers);
  const double gone = 0.5 * (late.state.settings.lie + late.state.settings.rise);
  late.step(1e6 + 300 + gone);
  EXPECT_GT(late.bent_by(), 0.02f);
  late.step(1e6 + 300 + 2 * gone);
  EXPECT_EQ(late.bent_by(), 0);
  EXPECT_TRUE(late.state.active.empty());
}

TEST(Hard, TimeThatStopsGoesBackOrIsNoNumber) {
  Meadow meadow;
  const Walkers walkers = ball({0, 0.12f, 0}, 0.25f);
  meadow.step(5, walkers);
  const std::vector<vec3> bent = meadow.joints_now();
  meadow.step(NAN, walkers);
  EXPECT_EQ(meadow.joints_now(), bent);
  meadow.step(5);
  EXPECT_EQ(meadow.joints_now(), bent);
  meadow.step(2);
  EXPECT_EQ(meadow.joints_now(), meadow.joints_of_wind());
  EXPECT_TRUE(meadow.state.active.empty());
}

TEST(Hard, SettingsOutOfRangeAreTheNearestInIt) {
  const Lawn lawn = make_lawn(small_meadow());
  const LawnState state = make_lawn_state(lawn, {-1, NAN, 0, 7});
  EXPECT_EQ(state.settings.lie, 0);
  EXPECT_GT(state.settings.rise, 0);
  EXPECT_GT(state.settings.settle, 0);
  EXPECT_EQ(state.settings.stiffness, 1);
}

}  // namespace
}  // namespace wellspring::test
