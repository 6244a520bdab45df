// SPDX-License-Identifier: Apache-2.0
// Every change of a kiosk's stage, on a clock of the test's own.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "base/layers.h"
#include "show/kiosk/kiosk.h"

namespace wellspring::test {
namespace {

constexpr double step = 0.1;

struct KioskStage : testing::Test {
  StageState state;
  KioskTimes times;
  StageInput input;
  int changes = 0;
  std::vector<Stage> seen{Stage::sleep};

  KioskStage() { input.camera = true; }
  Stage at(double time) {
    const Stage before = state.now, now = step_stage(state, times, input, time);
    input.touched = false;
    if (now != before) changes++, seen.push_back(now);
    return now;
  }
  // The same input for so long.
  Stage go(double seconds) {
    for (double end = state.time + seconds; state.time < end - 1e-9;) at(state.time + step);
    return state.now;
  }
  Stage touch() {
    input.touched = true;
    return at(state.time + step);
  }
  void nobody() { input.motion = input.head = input.busy = input.playing = false; }
  // A guest whom the camera sees, with a book open.
  void engage() {
    input.motion = input.head = input.busy = true;
    go(1);
    ASSERT_EQ(state.now, Stage::engaged);
  }
};

TEST_F(KioskStage, SleepsUntilSomethingMoves) {
  EXPECT_EQ(go(100), Stage::sleep);
  input.motion = true;
  EXPECT_EQ(go(step), Stage::awake);
  EXPECT_EQ(go(100), Stage::awake);
  input.motion = false;
  EXPECT_EQ(go(29.9), Stage::awake);
  EXPECT_EQ(go(0.3), Stage::sleep);
}

TEST_F(KioskStage, AHeadIsAPersonWhateverWasBefore) {
  input.head = true;
  EXPECT_EQ(go(step), Stage::person) << "from sleep";
  nobody();
  EXPECT_EQ(go(1.9), Stage::person) << "held";
  EXPECT_EQ(go(0.3), Stage::awake);
  input.head = true;
  EXPECT_EQ(go(step), Stage::person) << "from awake";
}

TEST_F(KioskStage, WhoOnlyWalksByIsNotBiddenFarewell) {
  input.motion = true;
  go(2);
  input.head = true;
  go(1.5);
  nobody();
  go(60);
  EXPECT_EQ(seen,
            (std::vector{Stage::sleep, Stage::awake, Stage::person, Stage::awake, Stage::sleep}));
}

TEST_F(KioskStage, WhoWasGreetedIs) {
  input.head = input.greeted = true;
  go(3);
  nobody();
  EXPECT_EQ(go(1.9), Stage::person);
  EXPECT_EQ(go(0.3), Stage::farewell);
}

TEST_F(KioskStage, WhoDoesSomethingIsEngaged) {
  input.head = true;
  EXPECT_EQ(go(5), Stage::person);
  EXPECT_EQ(touch(), Stage::person) << "waves on the water are no book";
  input.busy = true;
  EXPECT_EQ(go(step), Stage::engaged);
  input.busy = false;
  EXPECT_EQ(go(20), Stage::engaged) << "who closes the book is a guest still";
}

TEST_F(KioskStage, FarewellSixSecondsAfterTheLastHead) {
  engage();
  input.motion = input.head = false;
  EXPECT_EQ(go(5.9), Stage::engaged);
  EXPECT_EQ(go(0.3), Stage::farewell) << "though the book is open and something plays";
  nobody();
  EXPECT_EQ(go(5.8), Stage::farewell);
  EXPECT_EQ(go(0.3), Stage::sleep) << "nothing moved meanwhile";
}

TEST_F(KioskStage, AClosedHouseHasNoGuests) {
  engage();
  input.playing = input.closed = true;
  EXPECT_EQ(go(step), Stage::farewell) << "though somebody is there";
  touch();
  EXPECT_EQ(go(5.7), Stage::farewell);
  EXPECT_EQ(go(0.3), Stage::sleep);
  touch();
  EXPECT_EQ(go(100), Stage::sleep);
  input.closed = false;
  EXPECT_EQ(go(step), Stage::person);
  input.busy = false;
  input.closed = true;
  EXPECT_EQ(go(2 * step), Stage::sleep) << "who was not greeted";
  EXPECT_EQ(seen.back(), Stage::sleep);
  input.closed = input.head = false;
  EXPECT_EQ(go(step), Stage::awake);
  input.closed = true;
  EXPECT_EQ(go(step), Stage::sleep) << "at once";
}

TEST_F(KioskStage, NotWhileTouchesCome) {
  engage();
  input.head = false;
  for (int i = 0; i < 20; i++) {
    go(5);
    ASSERT_EQ(touch(), Stage::engaged) << i;
  }
}

TEST_F(KioskStage, WhoTouchesBesideTheCamerasViewStaysAsLongAsWithoutOne) {
  EXPECT_EQ(touch(), Stage::person);
  EXPECT_EQ(go(20), Stage::person);
  input.busy = true;
  EXPECT_EQ(go(24), Stage::engaged);
  EXPECT_EQ(touch(), Stage::engaged);
  EXPECT_EQ(go(44), Stage::engaged);
  EXPECT_EQ(go(1.5), Stage::farewell);
}

TEST_F(KioskStage, ATouchBesideAHeadDoesNotHideThatItHasLeft) {
  engage();
  touch();
  input.head = false;
  go(1);
  touch();
  EXPECT_EQ(go(5.5), Stage::engaged);
  EXPECT_EQ(go(0.8), Stage::farewell);
}

TEST_F(KioskStage, WithABrokenCameraTouchesEngage) {
  input.camera = false;
  EXPECT_EQ(touch(), Stage::person);
  EXPECT_EQ(go(10), Stage::person);
  EXPECT_EQ(touch(), Stage::engaged);
  EXPECT_EQ(go(44.9), Stage::engaged);
  EXPECT_EQ(go(0.4), Stage::farewell);
  EXPECT_EQ(go(6.2), Stage::sleep);
}

TEST_F(KioskStage, WithoutACameraWhoListensIsLeftInPeace) {
  input.camera = false;
  touch();
  touch();
  input.playing = true;
  EXPECT_EQ(go(89.9), Stage::engaged);
  EXPECT_EQ(go(0.4), Stage::farewell);
}

TEST_F(KioskStage, ACameraThatBreaksThrowsNobodyOutNorDoesOneThatIsBack) {
  engage();
  input.camera = input.head = input.motion = false;
  EXPECT_EQ(go(20), Stage::engaged);
  input.camera = true;  // and has not found the face again yet
  EXPECT_EQ(go(5.8), Stage::engaged);
  EXPECT_EQ(go(0.5), Stage::farewell);
}

TEST_F(KioskStage, ACameraThatComesAndGoesKeepsNobodyForEver) {
  engage();
  input.head = input.motion = input.busy = false;
  for (int i = 0; i < 500; i++) {
    input.camera = i % 2 == 0;
    go(step);
  }
  EXPECT_EQ(seen.at(3), Stage::farewell);
}

TEST_F(KioskStage, OfTwoOneLeavesAndTheOtherStays) {
  engage();  // a head is a head, however many there are
  go(60);
  EXPECT_EQ(state.now, Stage::engaged);
  EXPECT_EQ(changes, 2);
}

TEST_F(KioskStage, AReturnDuringFarewellCancelsIt) {
  engage();
  nobody();
  go(6.3);
  ASSERT_EQ(state.now, Stage::farewell);
  input.head = input.greeted = true;
  EXPECT_EQ(go(step), Stage::person);
  nobody();
  go(2.3);
  EXPECT_EQ(state.now, Stage::farewell) << "the visit goes on: its guest was greeted";
  EXPECT_EQ(touch(), Stage::person);
}

TEST_F(KioskStage, AfterFarewellItSleepsAtTwentySeconds) {
  engage();
  nobody();
  go(6.2);
  ASSERT_EQ(state.now, Stage::farewell);
  const double began = state.since;
  input.motion = true;
  go(5);
  nobody();
  go(2);
  EXPECT_EQ(state.now, Stage::awake) << "something moved meanwhile";
  go(began + 19.9 - state.time);
  EXPECT_EQ(state.now, Stage::awake);
  go(0.4);
  EXPECT_EQ(state.now, Stage::sleep);
}

TEST_F(KioskStage, MotionAfterFarewellIsSomebodyElse) {
  engage();
  nobody();
  go(6.2);
  const double began = state.since;
  input.motion = true;
  go(10);
  nobody();
  go(began + 25 - state.time);
  EXPECT_EQ(state.now, Stage::awake);
  EXPECT_EQ(go(30), Stage::sleep);
}

TEST_F(KioskStage, NothingFlapsAtTenHertz) {
  bool on = false;
  auto noise = [&](bool StageInput::*what, double seconds) {
    const int before = changes;
    for (double end = state.time + seconds; state.time < end;) {
      input.*what = on = !on;
      at(state.time + 0.05);
    }
    input.*what = false;
    return changes - before;
  };
  EXPECT_LE(noise(&StageInput::motion, 60), 1);
  EXPECT_EQ(state.now, Stage::awake);
  EXPECT_LE(noise(&StageInput::head, 60), 1);
  EXPECT_EQ(state.now, Stage::person);
  EXPECT_LE(noise(&StageInput::busy, 1), 1);
  EXPECT_EQ(state.now, Stage::engaged);
  EXPECT_EQ(noise(&StageInput::head, 60), 0);
  EXPECT_EQ(noise(&StageInput::camera, 5), 0);
  input.camera = true;
  EXPECT_EQ(go(6.4), Stage::farewell);
  EXPECT_LE(noise(&StageInput::motion, 60), 1);
  EXPECT_EQ(state.now, Stage::awake);
}

TEST_F(KioskStage, ClocksMayBeOdd) {
  engage();
  for (double odd : {std::nan(""), HUGE_VAL, -HUGE_VAL, -5.0, 0.0}) {
    EXPECT_EQ(at(odd), Stage::engaged);
    EXPECT_TRUE(std::isfinite(state.time) && std::isfinite(state.since));
  }
  nobody();
  EXPECT_EQ(at(1e7), Stage::farewell) << "one change a step, however long";
  EXPECT_EQ(at(2e7), Stage::sleep);
}

// Invariants of any sequence.
TEST_F(KioskStage, RandomGuests) {
  std::mt19937 random(20);
  auto chance = [&](double p) { return std::uniform_real_distribution(0.0, 1.0)(random) < p; };
  bool visit = false, met = false;  // as the changes so far say
  double noticed = -1e9;
  int farewells = 0;
  for (int i = 0; i < 10000; i++) {
    if (chance(0.05)) input.camera = !input.camera;
    if (chance(0.05)) input.motion = !input.motion;
    if (chance(0.05)) input.head = input.camera && !input.head;
    if (!input.camera) input.head = false;
    if (chance(0.05)) input.busy = !input.busy;
    if (chance(0.05)) input.playing = !input.playing;
    input.touched = chance(0.05);
    if (has_guest(state.now) && chance(0.1)) input.greeted = true;
    const bool touched = input.touched, greeted = input.greeted;
    const double time = state.time + std::exponential_distribution(chance(0.05) ? 0.02 : 2)(random);
    const Stage before = state.now, now = at(time);
    if (input.head || touched) noticed = time;
    ASSERT_TRUE(std::isfinite(state.time) && std::isfinite(state.since)) << i;
    ASSERT_EQ(state.time, time) << i;
    ASSERT_LE(state.since, state.time) << i;
    ASSERT_TRUE(!input.head || has_guest(now)) << i << ": who is seen is a guest";
    ASSERT_TRUE(!has_guest(now) || time - noticed < times.leave_playing + 1e-3) << i;
    if (now == Stage::person && before != Stage::person) visit = true;
    if (now == Stage::engaged) met = true;
    if (now == Stage::farewell && before != now) {
      farewells++;
      ASSERT_TRUE(visit && (met || greeted)) << i << ": farewell without a visit";
      ASSERT_TRUE(has_guest(before)) << i;
    }
    if (!is_visit(now)) visit = met = input.greeted = false;
  }
  EXPECT_GT(farewells, 20);
  nobody();
  for (double end = state.time + 130; state.time < end;) at(state.time + step);
  EXPECT_EQ(state.now, Stage::sleep);
}

}  // namespace
}  // namespace wellspring::test
