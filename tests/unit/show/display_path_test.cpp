// SPDX-License-Identifier: Apache-2.0
#include "show/display_path.h"

#include <gtest/gtest.h>

#include "cache/looks.h"

namespace wellspring {
namespace {

constexpr DisplayCosts quick{1e6, 100e6}, slow{1e5, 1e6};
constexpr size_t pixels = 1280 * 720;

TEST(DisplayPath, FollowsWhatWasMeasured) {
  EXPECT_TRUE(plan_display(0.1, pixels, quick, false).primary);
  EXPECT_FALSE(plan_display(0.01, pixels, slow, false).primary);
  // A smaller picture or more time per visitor is enough on the slow machine.
  EXPECT_TRUE(plan_display(0.1, 128 * 72, slow, false).primary);
}

TEST(DisplayPath, SpendsTheTimeThereIs) {
  for (const DisplayCosts& costs : {quick, slow})
    for (double seconds : {0.002, 0.01, 0.05, 0.2})
      for (bool primary : {false, true}) {
        DisplayPlan plan = plan_display(seconds, pixels, costs, primary);
        double spent = plan.samples / costs.samples_per_second + plan.looks / costs.looks_per_second;
        EXPECT_LE(spent, seconds + 2000 / costs.samples_per_second + 1e-9);
        EXPECT_GE(plan.samples, 2000);
        EXPECT_EQ(plan.looks == int(pixels) * looks_a_pixel, plan.primary);
      }
}

TEST(DisplayPath, DoesNotAlternateWhereBothAreAboutAsGood) {
  // Times that vary by a tenth around the limit change the path once at most.
  double at_limit = double(pixels) * looks_a_pixel / quick.looks_per_second / 0.45;
  bool primary = false;
  int changes = 0;
  for (int i = 0; i < 100; i++) {
    DisplayPlan plan = plan_display(at_limit * (i % 2 ? 1.1 : 0.9), pixels, quick, primary);
    changes += plan.primary != primary;
    primary = plan.primary;
  }
  EXPECT_LE(changes, 1);
}

TEST(DisplayPath, NothingMeasuredYetIsNoDivisionByZero) {
  DisplayPlan plan = plan_display(0.01, pixels, {}, false);
  EXPECT_FALSE(plan.primary);
  EXPECT_EQ(plan.looks, 0);
  EXPECT_EQ(plan.samples, 2000);
}

}  // namespace
}  // namespace wellspring
