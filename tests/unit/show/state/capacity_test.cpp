// SPDX-License-Identifier: Apache-2.0
#include "show/state/capacity.h"

#include <gtest/gtest.h>

#include <vector>

namespace wellspring {
namespace {

constexpr double pixels = 640 * 360;

// A capacity that has measured that a shown picture takes so many milliseconds of a core, and a
// keyframe so many.
std::shared_ptr<Capacity> measured(double shown_ms, double drawn_ms, CapacitySettings settings) {
  auto capacity = std::make_shared<Capacity>(settings);
  for (int i = 0; i < 5000; i++) {
    capacity->note_shown(pixels, 0.001 * shown_ms);
    capacity->note_drawn(pixels, 0.001 * drawn_ms);
  }
  return capacity;
}

size_t seats_of(Capacity& capacity, double each, size_t most = 500) {
  std::vector<std::unique_ptr<Seat>> seats;
  while (seats.size() < most) {
    auto seat = capacity.find_seat(each);
    if (!seat) break;
    seats.push_back(std::move(seat));
  }
  return seats.size();
}

TEST(Capacity, SeatsAreAsManyAsTheCoresServeAtTheLeastRate) {
  struct Row {
    double cores, rate, shown_ms, drawn_ms, pixels;
    size_t seats;
  };
  // A visitor takes rate * shown + 3 * 0.5 * drawn; 0.85 of the cores are for that.
  for (const Row& row : {
           Row{2, 15, 4, 20, pixels, 18},                                 // 0.09 cores each
           Row{4, 15, 4, 20, pixels, 37}, Row{4, 30, 4, 20, pixels, 22},  // 0.15
           Row{4, 15, 8, 40, pixels, 18},      // a machine of half the speed
           Row{4, 15, 4, 20, 4 * pixels, 10},  // its fixed part once, 3.65 times as much
       }) {
    auto capacity = measured(row.shown_ms, row.drawn_ms, {.rate = row.rate, .cores = row.cores});
    EXPECT_EQ(seats_of(*capacity, row.pixels), row.seats) << row.cores << " " << row.rate;
  }
}

TEST(Capacity, TheUpperBoundHoldsWhateverTheMachineCould) {
  auto capacity = measured(0.1, 0.1, {.most = 3, .cores = 64});
  EXPECT_EQ(seats_of(*capacity, pixels), 3u);
}

TEST(Capacity, TheFirstVisitorGetsASeatHoweverSlowTheMachine) {
  auto capacity = measured(5000, 5000, {.cores = 1});
  EXPECT_EQ(seats_of(*capacity, 1920 * 1200), 1u);
}

TEST(Capacity, KiosksGetASeatWhetherThereIsOneOrNot) {
  auto capacity = measured(5000, 5000, {.cores = 1});
  auto first = capacity->give_seat(pixels), second = capacity->give_seat(pixels);
  EXPECT_EQ(capacity->standing().seats, 2);
  EXPECT_FALSE(capacity->find_seat(pixels));
}

TEST(Capacity, WhoLeavesAndWhoseSizeChangesMakesRoom) {
  auto capacity = measured(4, 20, {.most = 2, .cores = 64});
  auto first = capacity->find_seat(pixels), second = capacity->find_seat(pixels);
  EXPECT_FALSE(capacity->find_seat(pixels));
  first.reset();
  EXPECT_TRUE(capacity->find_seat(pixels));
  const double before = capacity->standing().busy;
  second->resize(4 * pixels);
  EXPECT_NEAR(capacity->standing().busy,
              before * weighed_pixels(4 * pixels) / weighed_pixels(pixels), 1e-9);
  second.reset();
  EXPECT_EQ(capacity->standing().seats, 0);
  EXPECT_NEAR(capacity->standing().busy, 0, 1e-12);
}

TEST(Capacity, MeasurementsReplaceTheFirstGuessAndFollowTheMachine) {
  auto capacity = std::make_shared<Capacity>(CapacitySettings{.cores = 4});
  EXPECT_EQ(capacity->standing().cost, PictureCost{});
  const double value = 2e-8;
  for (int i = 0; i < 100; i++) capacity->note_shown(pixels, value * weighed_pixels(pixels));
  EXPECT_LT(capacity->standing().cost.shown, 0.5 * (PictureCost{}.shown + value));
  for (int i = 0; i < 3000; i++) capacity->note_shown(pixels, 3 * value * weighed_pixels(pixels));
  EXPECT_NEAR(capacity->standing().cost.shown, 3 * value, 0.02 * value);
}

}  // namespace
}  // namespace wellspring
