// SPDX-License-Identifier: Apache-2.0
#include "show/draw/pace.h"

#include <gtest/gtest.h>

#include <limits>

#include "show/state/renderer.h"
#include "unit/show/show_stage.h"

namespace wellspring::test {
namespace {

TEST(SkinPace, NobodySeesIt) { EXPECT_EQ(plan_skin(0, 1e6, 0).samples, 0); }

TEST(SkinPace, FewerAndSeldomerTheSmallerItIs) {
  constexpr double speed = 1e6;
  double before = 0;
  for (float pixels : {50.0f, 1000.0f, 5000.0f, 20000.0f}) {
    const SkinPace pace = plan_skin(pixels, speed, 0);
    const double a_second = pace.samples / pace.interval;
    EXPECT_GT(a_second, 1.5 * before);
    EXPECT_LE(pace.interval, 1);
    before = a_second;
  }
  // A hundredth of a second in each, of a person ten pixels wide.
  EXPECT_LT(plan_skin(300, speed, 0).samples / speed, 0.01 * plan_skin(300, speed, 0).interval);
}

TEST(SkinPace, HasBoundsAndNeedsLessOnceItIsKnown) {
  const SkinPace large = plan_skin(1e6f, 1e6, 0), known = plan_skin(1e6f, 1e6, 100);
  EXPECT_EQ(large.samples, 25000);
  EXPECT_EQ(large.interval, least_interval);
  EXPECT_EQ(known.samples, 6250);
  EXPECT_EQ(plan_skin(1e6f, 2e6, 100).samples, 2 * known.samples);
}

struct SkinSamples : testing::Test, ShowStage {
  size_t most = 0;
  void run_with_teller(dvec3 place) {
    tick_seconds = 0.01;
    Exhibit exhibit = make_tiny_exhibit();
    Character& figure = add_storyteller(exhibit, "anna", place).character;
    figure.positions = {{-0.4f, 0.6f, 0}, {0.4f, 0.6f, 0}, {0, 2.2f, 0}};
    figure.normals.assign(3, {0, 0, 1});
    begin(std::move(exhibit), settings_for("direct"));
    join(192, 128);
    for (int i = 0; i < 200; i++) {
      step();
      most = std::max(most, show->drawing->renderer.skin.traced);
    }
  }
};

TEST_F(SkinSamples, SomeWhereSheIsSeen) {
  run_with_teller({-2, 0, 0.5});
  EXPECT_GT(show->drawing->renderer.skin.turn, 0u);
  EXPECT_GT(most, 0u);
}

// The storyteller is in the cone of the visitor's view, and the wall across the room before it.
TEST_F(SkinSamples, NoneBehindAWall) {
  run_with_teller({-2, 0, -1.5});
  EXPECT_GT(show->drawing->renderer.skin.turn, 3u);
  EXPECT_EQ(most, 0u);
}

}  // namespace
}  // namespace wellspring::test
