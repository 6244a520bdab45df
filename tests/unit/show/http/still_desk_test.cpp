// SPDX-License-Identifier: Apache-2.0
// Finished pictures cost what they cost: who may ask for what, and which comes first.
#include "show/http/still_desk.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>

#include "show/state/make_show.h"
#include "unit/show/show_stage.h"

namespace wellspring::test {
namespace {

struct StillDeskTest : testing::Test {
  std::unique_ptr<Show> show = make_show(make_tiny_exhibit(), settings_for("direct"));
  StillRoom room{*show};
  std::mutex mutex;
  std::vector<std::pair<int, StillOutcome>> told;  // number of the question, in order
  std::atomic<int> gone{-1};                       // whoever asked that has left
  std::unique_ptr<StillDesk> desk;                 // the last member: its thread tells

  void begin(double most_seconds, double cheap_seconds = 4) {
    StillLimits limits{.most_seconds = most_seconds,
                       .cheap_seconds = cheap_seconds,
                       .address_pictures = 1,
                       .most_waiting = 100000};
    desk = std::make_unique<StillDesk>(limits);
  }
  static StillJob job(int spp, float yaw = 0) {
    StillJob one{.width = 96, .height = 54, .seconds = 36000, .spp = spp, .denoise = false};
    one.yaw = yaw;
    return one;
  }
  void ask(int number, const StillJob& wanted, const std::string& address = "here") {
    desk->ask(room, wanted,
              {.take =
                   [this, number](StillOutcome outcome) {
                     std::lock_guard lock(mutex);
                     told.push_back({number, std::move(outcome)});
                   },
               .gone = [this, number] { return gone == number; },
               .address = address});
  }
  std::vector<int> answered() {
    std::lock_guard lock(mutex);
    std::vector<int> numbers;
    for (const auto& [number, outcome] : told) numbers.push_back(number);
    return numbers;
  }
  StillOutcome outcome(int number) {
    std::lock_guard lock(mutex);
    for (const auto& [which, outcome] : told)
      if (which == number) return outcome;
    return {.status = 0};
  }
  // False: never, as far as one can tell.
  template <class Condition>
  static bool comes(const Condition& holds) {
    for (int i = 0; i < 6000 && !holds(); i++)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return holds();
  }
};

TEST_F(StillDeskTest, WhateverSamplesAreWishedForItGetsThoseThatFit) {
  begin(0.5);
  StillJob wish = job(max_still_spp);
  wish.width = 160, wish.height = 90;  // one sample of which fits on any machine
  ask(0, wish);
  EXPECT_LE(desk->status().waiting_seconds, 0.5);
  ask(1, job(3));
  ASSERT_TRUE(comes([&] { return answered().size() == 2; }));
  EXPECT_EQ(outcome(0).status, 200);
  EXPECT_GE(outcome(0).picture.spp, 1);
  EXPECT_LE(outcome(1).picture.spp, 3);
  EXPECT_EQ(desk->status().too_dear, 0u);
}

TEST_F(StillDeskTest, OneThatTakesTooLongWithASampleIsToldWhatFits) {
  begin(0.001);
  StillJob large = job(1);
  large.width = large.height = 3840;
  ask(0, large);
  const StillOutcome refused = outcome(0);
  EXPECT_EQ(refused.status, 400);
  EXPECT_EQ(refused.code, "too_much_work");
  const size_t at = refused.problem.find(": ");
  ASSERT_NE(at, std::string::npos) << refused.problem;
  const int fits = std::stoi(refused.problem.substr(at + 2));
  EXPECT_GE(fits, 1);
  EXPECT_LT(fits, 3840 * 3840);
  EXPECT_EQ(desk->status().too_dear, 1u);
}

TEST_F(StillDeskTest, AnAddressHasSoManySecondsAndOthersHaveTheirs) {
  begin(0.5);
  int number = 0;
  for (; number < 20000 && outcome(number - 1).status != 429; number++)
    ask(number, job(1, 1e-4f * float(number)));
  const StillOutcome refused = outcome(number - 1);
  ASSERT_EQ(refused.status, 429);
  EXPECT_GT(number, 1) << "the first passes";
  EXPECT_GT(refused.retry_seconds, 0);
  EXPECT_EQ(desk->status().too_many, 1u);
  ask(number, job(1, 3), "elsewhere");
  EXPECT_NE(outcome(number).status, 429);
}

TEST_F(StillDeskTest, ACheapOneDoesNotWaitForADearOneThatIsAtWork) {
  begin(36000, 60);
  ask(0, job(200000));
  ask(1, job(1));
  ASSERT_TRUE(comes([&] { return !answered().empty(); }));
  EXPECT_EQ(answered(), std::vector<int>{1});
  EXPECT_EQ(desk->status().waiting, 1u);
}

TEST_F(StillDeskTest, CheapOnesComeBeforeDearOnesThatNobodyHasBegun) {
  begin(3600, 0);     // by one thread alone
  ask(0, job(4000));  // at work for long
  ASSERT_TRUE(comes([&] { return desk->status().waiting == 1; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  ask(1, job(16));
  ask(2, job(2));
  ask(3, job(4));
  gone = 0;
  ASSERT_TRUE(comes([&] { return answered().size() == 4; }));
  std::vector<int> order = answered();
  std::erase(order, 0);
  EXPECT_EQ(order, (std::vector<int>{2, 3, 1}));
}

TEST_F(StillDeskTest, WhatNobodyWaitsForIsGivenUpAndCostsNothing) {
  begin(3600);
  ask(0, job(4000));
  const double cost = desk->status().waiting_seconds;
  ASSERT_TRUE(comes([&] { return desk->status().waiting == 1; }));
  gone = 0;
  ASSERT_TRUE(comes([&] { return desk->status().waiting == 0; }));
  EXPECT_EQ(desk->status().given_up, 1u);
  EXPECT_EQ(desk->status().made, 0u);
  EXPECT_GT(cost, 0);
  // Its seconds are there again.
  begin(3 * cost);
  for (int i = 1; i < 6; i++) {
    gone = -1;
    ask(i, job(4000, 0.1f * float(i)));
    EXPECT_NE(outcome(i).status, 429) << i;
    gone = i;
    ASSERT_TRUE(comes([&] { return desk->status().waiting == 0; }));
  }
}

TEST_F(StillDeskTest, EqualQuestionsShareOnePicture) {
  begin(60);
  for (int i = 0; i < 3; i++) ask(i, job(8));
  ASSERT_TRUE(comes([&] { return answered().size() == 3; }));
  ask(3, job(8));
  EXPECT_EQ(desk->status().made, 1u);
  EXPECT_EQ(desk->status().shared, 3u);
  for (int i = 0; i < 4; i++) EXPECT_EQ(outcome(i).picture.jpeg, outcome(0).picture.jpeg) << i;
  EXPECT_GT(outcome(0).picture.jpeg.size(), 1000u);
}

TEST_F(StillDeskTest, ClosedItTellsWhoeverWaitsAndIsAtRest) {
  begin(3600);
  for (int i = 0; i < 10; i++) ask(i, job(4000, 0.1f * float(i)), "address " + std::to_string(i));
  desk->close();
  EXPECT_EQ(answered().size(), 10u);
  for (int i = 0; i < 10; i++) EXPECT_EQ(outcome(i).status, 503) << i;
  ask(10, job(1));
  EXPECT_EQ(outcome(10).status, 503);
  desk->open();
  ask(11, job(1));
  ASSERT_TRUE(comes([&] { return outcome(11).status == 200; }));
}

}  // namespace
}  // namespace wellspring::test
