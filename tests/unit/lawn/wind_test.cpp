// SPDX-License-Identifier: Apache-2.0
#include "lawn/wind.h"

#include <gtest/gtest.h>

#include "made.h"

namespace wellspring::test {
namespace {

// Computes the formula of lawn/wind.h in doubles, as a page would.
dvec2 exact_push(const Wind& wind, dvec2 place, double time) {
  dvec2 push = wind.lean;
  for (const WindWave& w : wind.waves)
    push += dvec2(w.push) * std::sin(dot(dvec2(w.wave), place) - w.rate * time + w.phase);
  return double(wind.strength) * push;
}

TEST(Wind, IsItsFormulaAtAnyHour) {
  Wind wind;
  wind.strength = 1.5f;
  for (const double time : {0.0, 3.7, 3600.0, 1e6, 1e6 + 1 / 60.0, -5.0}) {
    const WindNow now(wind, time);
    for (float x = -40; x < 40; x += 7.3f) {
      const Lanes at_x = x + Lanes{0, 0.1f, 0.3f, 0.7f, 1, 2, 3, 5}, at_z = 0.4f * at_x - 3;
      Lanes push_x, push_z;
      now.push_at(at_x, at_z, push_x, push_z);
      for (int lane = 0; lane < lane_count; lane++) {
        const dvec2 exact = exact_push(wind, {at_x[lane], at_z[lane]}, time);
        EXPECT_NEAR(push_x[lane], exact.x, 2e-5) << time;
        EXPECT_NEAR(push_z[lane], exact.y, 2e-5) << time;
      }
    }
  }
}

TEST(Wind, GrassIsPerfectlyStillWithoutStrength) {
  const Lawn lawn = make_lawn(small_meadow());
  LawnState state = make_lawn_state(lawn);
  const Wind still{.strength = 0}, breeze;
  const auto joints_at = [&](const Wind& wind, double time) {
    step_lawn(state, lawn, wind, {}, time);
    return all_joints(lawn, state, wind);
  };
  const std::vector<vec3> first = joints_at(still, 1), moved = joints_at(breeze, 1);
  EXPECT_EQ(first, joints_at(still, 17.3));
  EXPECT_EQ(moved, joints_at(breeze, 1));
  EXPECT_GT(farthest(first, moved), 0.01f);
  EXPECT_NE(moved, joints_at(breeze, 1.1));
  EXPECT_EQ(first, joints_at(Wind{.strength = NAN, .lean = vec2(0)}, 2));
}

TEST(Wind, BladesKeepTheirLength) {
  const Lawn lawn = make_lawn(small_meadow());
  LawnState state = make_lawn_state(lawn);
  Wind gale;
  gale.strength = 6;
  step_lawn(state, lawn, gale, {}, 4.2);
  for_blades(lawn, state, gale, [&](int, int blade, const BladeShapes& shapes, int lane) {
    for (int k = 0; k < segments; k++)
      EXPECT_NEAR(glm::length(shapes.joint[k + 1].at(lane) - shapes.joint[k].at(lane)),
                  lawn.length[size_t(blade)] / segments, 1e-6f);
  });
}

}  // namespace
}  // namespace wellspring::test
