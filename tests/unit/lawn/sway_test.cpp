// SPDX-License-Identifier: Apache-2.0
// A display is told how far blades sway (eval_sway): it has to be as far as they do.
#include <gtest/gtest.h>

#include "made.h"

namespace wellspring::test {
namespace {

// Returns the tips' mean way along a push that comes on top of the lean, and what eval_sway() says
// of it; of blades that `state` has bent alone, or of all.
struct Ways {
  double found = 0, told = 0;
  int blades = 0;
};
Ways mean_ways(const Lawn& lawn, const LawnState& state, vec2 push, bool bent_alone = false) {
  Wind before;
  for (WindWave& wave : before.waves) wave.push = vec2(0);
  Wind after = before;
  after.lean += push;
  const WindNow pushed(after, state.time);
  Ways ways;
  for_blades(lawn, state, before, [&](int tile, int blade, const BladeShapes& shapes, int lane) {
    if (lane > 0) return;
    const BentTile& bent = state.bent[size_t(tile)];
    const size_t at = size_t(blade - lawn.tile[size_t(tile)].begin);
    if (bent_alone && (bent.touched.empty() || !std::isfinite(bent.touched[at]))) return;
    const BladeShapes moved = eval_shapes(lawn, state, pushed, tile, blade);
    const vec3 way = moved.joint[segments].at(0) - shapes.joint[segments].at(0);
    const float strength = glm::length(push);
    ways.found += double(dot(vec2(way.x, way.z), push)) / double(strength);
    ways.told += double(eval_sway(lawn, blade, shapes).joint[segments][0] * strength);
    ways.blades++;
  });
  return ways;
}

TEST(Sway, IsAsFarAsAPushMovesTips) {
  const Lawn lawn = make_lawn(small_meadow());
  const LawnState state = make_lawn_state(lawn);
  for (const vec2 push : {vec2(0.1f, 0), vec2(-0.15f, 0.1f), vec2(0, 0.3f)}) {
    const Ways ways = mean_ways(lawn, state, push);
    ASSERT_GT(ways.blades, 500);
    EXPECT_GT(ways.found / ways.blades, 0.003);
    EXPECT_NEAR(ways.told / ways.found, 1, 0.1) << push.x << " " << push.y;
  }
}

TEST(Sway, RootsStayAndTipsGoFarthest) {
  const Lawn lawn = make_lawn(small_meadow());
  const LawnState state = make_lawn_state(lawn);
  for_blades(lawn, state, {}, [&](int, int blade, const BladeShapes& shapes, int lane) {
    if (lane > 0) return;
    const BladeSway sway = eval_sway(lawn, blade, shapes);
    EXPECT_EQ(sway.joint[0][0], 0);
    for (int k = 0; k < segments; k++) EXPECT_GT(sway.joint[k + 1][0], sway.joint[k][0]);
  });
}

TEST(Sway, BladesThatLieDoNotMoveUntilTheyRise) {
  const Lawn lawn = make_lawn(small_meadow());
  LawnState state = make_lawn_state(lawn);
  step_lawn(state, lawn, {}, ball({0, 0.02f, 0}, 0.3f), 0);
  const vec2 push(0.2f, 0);
  const Ways lying = mean_ways(lawn, state, push, true);
  ASSERT_GT(lying.blades, 5);
  EXPECT_EQ(lying.told, 0);
  EXPECT_NEAR(lying.found / lying.blades, 0, 1e-5);
  step_lawn(state, lawn, {}, {}, state.settings.lie + 0.5 * state.settings.rise);
  const Ways rising = mean_ways(lawn, state, push, true);
  ASSERT_EQ(rising.blades, lying.blades);
  EXPECT_GT(rising.found / rising.blades, 0.003);
  EXPECT_NEAR(rising.told / rising.found, 1, 0.25);
}

}  // namespace
}  // namespace wellspring::test
