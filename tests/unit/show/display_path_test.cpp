// SPDX-License-Identifier: Apache-2.0
#include "show/display_path.h"

#include <gtest/gtest.h>

#include <limits>

#include "cache/looks.h"

namespace wellspring {
namespace {

constexpr DisplayCosts quick{1e6, 100e6, 0.003, 0.01}, slow{1e5, 1e6, 0.09, 0.02};
constexpr DisplayPlan points, drawn{true, false}, looked{false, true};
constexpr size_t pixels = 1280 * 720;

TEST(DisplayPath, FollowsWhatWasMeasured) {
  EXPECT_TRUE(plan_display(0.1, pixels, quick, points).primary);
  EXPECT_FALSE(plan_display(0.01, pixels, slow, points).primary);
  // A smaller picture or more time per visitor is enough on the slow machine.
  EXPECT_TRUE(plan_display(0.1, 128 * 72, slow, points).primary);
}

TEST(DisplayPath, SpendsTheTimeThereIs) {
  for (const DisplayCosts& costs : {quick, slow})
    for (double seconds : {0.002, 0.01, 0.05, 0.2})
      for (const DisplayPlan& before : {points, drawn, looked}) {
        DisplayPlan plan = plan_display(seconds, pixels, costs, before);
        double spent = plan.samples / costs.samples_per_second +
                       plan.looks / costs.looks_per_second +
                       (plan.drawn ? costs.drawing_seconds : 0);
        // Light keeps a quarter of the time even where drawing slows pictures down.
        double slowed = plan.drawn ? std::max(0.0, costs.drawing_seconds - 0.75 * seconds) : 0;
        double saved = plan.drawn ? 0.6 * costs.display_seconds : 0;  // by coarser light
        EXPECT_LE(spent, seconds + saved + slowed + 2000 / costs.samples_per_second + 1e-9);
        EXPECT_GE(plan.samples, plan.drawn ? 1000 : 2000);
        EXPECT_EQ(plan.looks == int(pixels) * looks_a_pixel, plan.primary);
      }
}

// However dear drawing is, who stands gets a quarter of the time in light; who moves is shown more
// pictures.
TEST(DisplayPath, WhoStandsGetsAQuarterInLight) {
  for (double drawing : {0.01, 0.05, 0.2}) {
    DisplayCosts costs{1e6, 100e6, drawing, 0.03};
    DisplayPlan still = plan_display(0.01, pixels, costs, drawn, true, DrawShapes::always),
                moving = plan_display(0.01, pixels, costs, drawn, false, DrawShapes::always);
    double light = still.samples / costs.samples_per_second;
    EXPECT_NEAR(light, 0.25 * (light + drawing + costs.display_seconds), 1e-3 * light + 1e-6);
    if (drawing > 0.02) {
      EXPECT_LT(moving.samples, still.samples);
    }
  }
}

TEST(DisplayPath, DoesNotAlternateWhereBothAreAboutAsGood) {
  // Times that vary by a tenth around the limit change the path once at most.
  double at_limit = double(pixels) * looks_a_pixel / quick.looks_per_second / 0.45;
  DisplayPlan plan;
  int changes = 0;
  for (int i = 0; i < 100; i++) {
    DisplayPlan next = plan_display(at_limit * (i % 2 ? 1.1 : 0.9), pixels, quick, plan);
    changes += plan.primary != next.primary;
    plan = next;
  }
  EXPECT_LE(changes, 1);
  plan = {}, changes = 0;
  for (int i = 0; i < 100; i++) {
    DisplayPlan next =
        plan_display(slow.drawing_seconds / 0.7 * (i % 2 ? 1.05 : 0.95), pixels, slow, plan);
    changes += plan.drawn != next.drawn;
    plan = next;
  }
  EXPECT_LE(changes, 1);
}

TEST(DisplayPath, DrawsWhereTimeOrTheRateAllows) {
  DisplayCosts slower = slow;
  slower.drawing_seconds = 0.7;
  EXPECT_FALSE(plan_display(0.03, pixels, slower, points).drawn);
  EXPECT_FALSE(plan_display(0.03, pixels, slower, drawn).drawn);
  DisplayCosts dear = slow;  // light
  dear.samples_per_second = 5e4;
  EXPECT_TRUE(plan_display(0.16, pixels, dear, points).drawn);
  // However many samples there are: points show wrong surfaces.
  DisplayCosts plenty = slow;
  plenty.samples_per_second = 6e5;
  EXPECT_TRUE(plan_display(0.22, pixels, plenty, points).drawn);
  EXPECT_TRUE(plan_display(0.22, pixels, plenty, points, true).drawn);
  EXPECT_TRUE(plan_display(0.22, pixels, slow, points).drawn);
  EXPECT_TRUE(plan_display(0.007, pixels, quick, points).drawn);
  // No time is left within the wanted period, but two pictures a second stay possible.
  DisplayCosts costs = slow;
  costs.drawing_seconds = 0.008;
  EXPECT_TRUE(plan_display(0.005, pixels, costs, points).drawn);
  EXPECT_GE(plan_display(0.005, pixels, costs, points).samples, 1000);
  costs.drawing_seconds = 0.15;
  EXPECT_TRUE(plan_display(0.005, pixels, costs, points).drawn);
  costs.drawing_seconds = 0.6;
  EXPECT_FALSE(plan_display(0.005, pixels, costs, drawn).drawn);
  // What a picture takes in coarser light is what counts once it is known.
  costs.display_seconds = 0.1, costs.drawing_seconds = 0.02, costs.light_seconds = 0.005;
  EXPECT_TRUE(plan_display(0.005, pixels, costs, points).drawn);
  EXPECT_EQ(plan_display(0.005, pixels, costs, points).looks, 0);
  costs.light_seconds = 0.6;
  EXPECT_FALSE(plan_display(0.005, pixels, costs, drawn).drawn);
  EXPECT_FALSE(plan_display(0.005, pixels, slower, drawn, true).drawn);
}

TEST(DisplayPath, LightBecomesFineWhenItIsKnown) {
  EXPECT_FALSE(wants_fine_light(false, true, 0));
  EXPECT_FALSE(wants_fine_light(false, false, 0));  // moves again
  EXPECT_FALSE(wants_fine_light(true, true, 0.9f));
  EXPECT_TRUE(wants_fine_light(true, true, 0.1f));
  EXPECT_TRUE(wants_fine_light(true, false, 0.9f));  // and stays so
}

TEST(DisplayPath, WhoMovesHasFineLightWhereSamplesAreNotFew) {
  EXPECT_FALSE(affords_fine_light(0, false));
  EXPECT_FALSE(affords_fine_light(0.2, true));
  EXPECT_TRUE(affords_fine_light(0.5, false));
  // It costs samples, which is no reason to give it up again.
  EXPECT_FALSE(affords_fine_light(0.35, false));
  EXPECT_TRUE(affords_fine_light(0.35, true));
}

TEST(DisplayPath, TheReferenceComesLast) {
  EXPECT_FALSE(wants_reference(1, false, false, 0, 1));
  EXPECT_FALSE(wants_reference(30, false, true, 0, 1));  // light is coarse yet
  EXPECT_FALSE(wants_reference(30, false, false, 0.4f, 0.6f));
  EXPECT_FALSE(
      wants_reference(30, false, false, 0.05f, 0.3f));  // of few samples its noise would show
  EXPECT_TRUE(wants_reference(30, false, false, 0.05f, 0.6f));
  EXPECT_TRUE(
      wants_reference(30, true, false, 0.15f, 0.4f));  // the storyteller moves: what she hid is new
  EXPECT_FALSE(wants_reference(0.5, true, false, 0, 1));       // walks again
}

TEST(DisplayPath, DrawsAsToldByTheOperator) {
  EXPECT_FALSE(plan_display(1, 128 * 72, quick, drawn, false, DrawShapes::never).drawn);
  EXPECT_TRUE(plan_display(0.001, pixels, slow, points, false, DrawShapes::always).drawn);
}

TEST(DisplayPath, NothingMeasuredYetIsNoDivisionByZero) {
  DisplayPlan plan = plan_display(0.01, pixels, {}, points);
  EXPECT_FALSE(plan.primary);
  EXPECT_EQ(plan.looks, 0);
  EXPECT_TRUE(plan.drawn);  // so that it is measured
  EXPECT_EQ(plan.samples, 1000);
}

}  // namespace
}  // namespace wellspring
