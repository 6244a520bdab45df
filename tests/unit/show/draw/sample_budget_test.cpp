// SPDX-License-Identifier: Apache-2.0
#include "base/layers.h"
#include "show/draw/decide.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace wellspring::test {
namespace {

constexpr DrawingCosts quick{1e6, 0.003, 0.01}, slow{1e5, 0.09, 0.02};
constexpr size_t pixels = 1280 * 720;

TEST(SampleBudget, SpendsTheTimeThereIs) {
  for (const DrawingCosts& costs : {quick, slow})
    for (double seconds : {0.002, 0.01, 0.05, 0.2}) {
      int samples = sample_budget(seconds, pixels, costs, false);
      double spent = samples / costs.samples_per_second + costs.drawing_seconds;
      // Light keeps a quarter of the time even where drawing slows pictures down.
      double slowed = std::max(0.0, costs.drawing_seconds - 0.75 * seconds);
      double saved = 0.6 * costs.display_seconds;  // by a picture for who moves
      EXPECT_LE(spent, seconds + saved + slowed + 1000 / costs.samples_per_second + 1e-9);
      EXPECT_GE(samples, 1000);
      if (seconds > 2 * costs.drawing_seconds) {
        EXPECT_GE(spent, 0.99 * std::min(seconds, pixels / 2 / costs.samples_per_second));
      }
    }
}

// However dear drawing is, who stands gets a quarter of the time in light; who moves is shown more
// pictures.
TEST(SampleBudget, WhoStandsGetsAQuarterInLight) {
  for (double drawing : {0.01, 0.05, 0.2}) {
    DrawingCosts costs{1e6, drawing, 0.03};
    int still = sample_budget(0.01, pixels, costs, true),
        moving = sample_budget(0.01, pixels, costs, false);
    double light = still / costs.samples_per_second;
    EXPECT_NEAR(light, 0.25 * (light + drawing + costs.display_seconds), 1e-3 * light + 1e-6);
    if (drawing > 0.02) {
      EXPECT_LT(moving, still);
    }
  }
}

// Once the cost of pictures in motion is known, it counts.
TEST(SampleBudget, FollowsWhatPassingPicturesTake) {
  DrawingCosts costs{1e5, 0.02, 0.1, 0};
  int guessed = sample_budget(0.1, pixels, costs, false);
  costs.light_seconds = 0.005;
  int less = sample_budget(0.1, pixels, costs, false);
  costs.light_seconds = 0.1;
  int more = sample_budget(0.1, pixels, costs, false);
  EXPECT_GT(less, guessed);
  EXPECT_LT(more, guessed);
}

TEST(SampleBudget, SmallPicturesNeedNoMoreSamplesThanTheyHavePixels) {
  EXPECT_EQ(sample_budget(0, 64, slow, false), 64);
  EXPECT_EQ(sample_budget(1, 96 * 64, quick, true), 96 * 64 / 2);
  EXPECT_EQ(sample_budget(1, 0, quick, true), 0);
}

TEST(PlanKeyframe, ResolutionFallsBeforeKeyframesComeLate) {
  struct {
    double seconds;  // time of a keyframe of scale `before`
    float before, scale;
    double period;
  } const table[] = {
      {0.005, 1, 1, 1 / 30.0},
      {0.05, 1, 1, 0.05 / 0.7},
      {0.069, 1, 1, 0.069 / 0.7},
      {0.08, 1, 0.75f, 0.06 / 0.7},
      {0.12, 1, 0.5f, 0.06 / 0.7},
      {0.6, 1, 0.375f, 0.1},
      {0, 1, 1, 1 / 30.0},  // nothing measured yet
      // It climbs back when there is time to spare.
      {0.06, 0.75f, 0.75f, 0.06 / 0.7},
      {0.04, 0.75f, 0.75f, 0.04 / 0.7},
      {0.03, 0.75f, 1, 0.04 / 0.7},
      {0.01, 0.375f, 1, 0.08 / 3 / 0.7},
      {0.07, 0.375f, 0.375f, 0.1},
      {0.35, 0.375f, 0.375f, 0.1},
  };
  for (const auto& one : table) {
    KeyframePlan plan = plan_keyframe(one.seconds, one.before, finished_period);
    EXPECT_EQ(plan.scale, one.scale) << one.seconds << " at " << one.before;
    EXPECT_NEAR(plan.period, one.period, 1e-6) << one.seconds << " at " << one.before;
  }
}

// A page that draws by itself goes without a new keyframe until what it cannot know would show.
TEST(PlanKeyframe, WhoPassesNearThingsNeedsMany) {
  struct {
    Ageing ageing;
    double least, most;  // seconds
  } const table[] = {
      {{0, 0}, 0.33, 0.34},         // nothing changes
      {{0, 0.2f}, 0.33, 0.34},      // looks round slowly
      {{0, 1}, 0.12, 0.15},         // a picture's width a second
      {{0, 20}, 0.1, 0.1},          // spins
      {{0.05f, 0}, 0.33, 0.34},     // walks through an empty hall
      {{0.18f, 0.1f}, 0.13, 0.17},  // strolls past show-cases
      {{1, 0}, 0.1, 0.1},           // along a fence
      {{NAN, NAN}, 0.1, 0.34},
  };
  for (const auto& one : table) {
    const double period = longest_period(one.ageing);
    EXPECT_GE(period, one.least) << one.ageing.uncovered << " " << one.ageing.turned_to;
    EXPECT_LE(period, one.most) << one.ageing.uncovered << " " << one.ageing.turned_to;
    // The same cost leaves it more pixels than it leaves a finished picture.
    for (double seconds : {0.08, 0.12, 0.2})
      EXPECT_GE(plan_keyframe(seconds, 1, period).scale,
                plan_keyframe(seconds, 1, finished_period).scale);
  }
}

// If nothing changes, the next picture is not of another size again.
TEST(PlanKeyframe, Settles) {
  for (double full = 0.01; full < 0.4; full += 0.003)
    for (float before : {1.0f, 0.75f, 0.5f, 0.375f}) {
      float first = plan_keyframe(full * keyframe_cost(before), before, finished_period).scale;
      EXPECT_EQ(plan_keyframe(full * keyframe_cost(first), first, finished_period).scale, first)
          << full;
    }
}

TEST(TourPace, SlowsDownWhereAKeyframeWouldMissAFifth) {
  EXPECT_EQ(tour_pace(0, 1.5f), 1);
  EXPECT_EQ(tour_pace(0.29f, 1.5f), 1);
  EXPECT_FLOAT_EQ(tour_pace(0.6f, 1.5f), 0.5f);
  EXPECT_FLOAT_EQ(tour_pace(3, 1.5f), 0.1f);
}

TEST(SampleBudget, TheReferenceComesLast) {
  EXPECT_FALSE(wants_reference(1, false, 0, 1));
  EXPECT_FALSE(wants_reference(30, false, 0.4f, 0.6f));
  EXPECT_FALSE(wants_reference(30, false, 0.05f, 0.3f));  // with few samples its noise would show
  EXPECT_TRUE(wants_reference(30, false, 0.05f, 0.6f));
  // The storyteller moves: what it hid is new.
  EXPECT_TRUE(wants_reference(30, true, 0.15f, 0.4f));
  EXPECT_FALSE(wants_reference(0.5, true, 0, 1));  // walks again
}

TEST(SampleBudget, NothingMeasuredYetIsNoDivisionByZero) {
  EXPECT_EQ(sample_budget(0.02, pixels, DrawingCosts{}, false), 1000);
  EXPECT_EQ(sample_budget(0.02, pixels, DrawingCosts{}, true), 1000);
}

}  // namespace
}  // namespace wellspring::test
