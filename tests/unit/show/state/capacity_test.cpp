// SPDX-License-Identifier: Apache-2.0
#include "base/layers.h"
#include "show/state/capacity.h"

#include <gtest/gtest.h>

#include <vector>

namespace wellspring::test {
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
  // A visitor takes rate * shown + min(3, rate) * 0.5 * drawn; 0.85 of the cores are for that.
  for (const Row& row : {
           Row{2, 15, 4, 20, pixels, 18},                                 // 0.09 cores each
           Row{4, 15, 4, 20, pixels, 37}, Row{4, 30, 4, 20, pixels, 22},  // 0.15
           Row{4, 15, 8, 40, pixels, 18},      // a machine of half the speed
           Row{2, 1, 4, 20, pixels, 121},      // no more keyframes than pictures
           Row{4, 15, 4, 20, 4 * pixels, 10},  // its fixed part once, 3.65 times as much
       }) {
    auto capacity = measured(row.shown_ms, row.drawn_ms, {.rate = row.rate, .cores = row.cores});
    EXPECT_EQ(seats_of(*capacity, row.pixels), row.seats) << row.cores << " " << row.rate;
  }
}

TEST(Capacity, WhosePageDrawsByItselfTakesLess) {
  auto capacity = measured(4, 20, {.rate = 15, .cores = 2});
  for (int i = 0; i < 5000; i++) capacity->note_sent(pixels, 0.005);
  // 2 * (0.5 * 20 + 5) ms, of 1.7 cores.
  EXPECT_EQ(capacity->seats_for({pixels, true}), 56);
  EXPECT_EQ(capacity->seats_for(pixels), 18);
  auto seat = capacity->find_seat({pixels, true});
  const double busy = capacity->standing().busy;
  EXPECT_NEAR(busy, 0.03, 1e-3);
  EXPECT_TRUE(seat->resize({pixels, false})) << "a device that cannot do it is served all the same";
  EXPECT_NEAR(capacity->standing().busy, 0.09, 1e-3);
  EXPECT_TRUE(seat->resize({pixels, true}));
  EXPECT_DOUBLE_EQ(capacity->standing().busy, busy);
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

TEST(Capacity, WhoWantsLargerPicturesAsksForASeatAsANewcomerDoes) {
  auto capacity = measured(4, 20, {.cores = 2});  // for 18 of these, or 4.9 of four times the size
  std::vector<std::unique_ptr<Seat>> seats;
  for (int i = 0; i < 10; i++) seats.push_back(capacity->find_seat(16 * 16));
  int grown = 0;
  for (const auto& seat : seats) grown += seat->resize(4 * pixels);
  EXPECT_GE(grown, 3);
  EXPECT_LE(grown, 5);
  const double busy = capacity->standing().busy;
  EXPECT_LE(busy, capacity->standing().cores);
  EXPECT_FALSE(seats.back()->resize(4 * pixels));
  EXPECT_EQ(capacity->standing().busy, busy) << "what was refused changes nothing";
  EXPECT_TRUE(seats.front()->resize(16 * 16)) << "smaller ones always fit";
  EXPECT_TRUE(seats.back()->resize(4 * pixels));
  auto kiosk = capacity->give_seat(pixels);
  EXPECT_TRUE(kiosk->resize(4 * pixels)) << "a kiosk's is given";
}

TEST(Capacity, MemoryBoundsSeatsAsCoresDo) {
  const double each = visitor_bytes(pixels);
  auto capacity = measured(0.1, 0.1, {.cores = 64, .memory = 5.5 * each});
  std::vector<std::unique_ptr<Seat>> seats;
  while (auto seat = capacity->find_seat(pixels)) seats.push_back(std::move(seat));
  EXPECT_EQ(seats.size(), 5u);
  EXPECT_EQ(capacity->seats_for(pixels), 5);
  EXPECT_NEAR(capacity->standing().bytes, 5 * each, 1);
  EXPECT_FALSE(seats[0]->resize(2 * pixels));
  seats.pop_back();
  EXPECT_TRUE(seats[0]->resize(2 * pixels));
}

TEST(Capacity, WhoseAddressHasNoSeatComesInWhateverOthersHaveTaken) {
  const double each = visitor_bytes(pixels);
  for (const CapacitySettings& settings :
       {CapacitySettings{.cores = 2, .memory = 1e12},  // 18 by cores
        CapacitySettings{.most = 16, .cores = 64, .memory = 1e12},
        CapacitySettings{.cores = 64, .memory = 16.5 * each}}) {
    auto capacity = measured(4, 20, settings);
    std::vector<std::unique_ptr<Seat>> seats;
    while (auto seat = capacity->find_seat(pixels, "a")) seats.push_back(std::move(seat));
    EXPECT_GE(seats.size(), 14u) << "others leave it nearly all";
    auto other = capacity->find_seat(pixels, "b");
    ASSERT_TRUE(other);
    EXPECT_EQ(capacity->seats_of("b"), 1);
    if (settings.most > 100)
      EXPECT_FALSE(other->resize(8 * pixels)) << "but what it has more is for newcomers alone";
    while (auto seat = capacity->find_seat(pixels, "b")) seats.push_back(std::move(seat));
    EXPECT_LE(capacity->seats_of("b"), 2);
  }
}

TEST(Capacity, OneThatTakesMoreThanAllKeepsNobodyElseOut) {
  auto capacity = measured(40, 200, {.cores = 2, .memory = 1e12});  // 0.9 cores each
  auto first = capacity->find_seat(9 * pixels, "a");
  EXPECT_GT(capacity->standing().busy, capacity->standing().cores);
  EXPECT_FALSE(capacity->find_seat(pixels / 8, "a"));
  EXPECT_TRUE(capacity->find_seat(pixels / 8, "b"));
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
}  // namespace wellspring::test
