// SPDX-License-Identifier: Apache-2.0
// How much a worker is sent follows from what was measured of it.
#include "workers/budget.h"

#include <gtest/gtest.h>

namespace wellspring::test {
namespace {

// Sends what there is room for; the worker answers each second so many requests.
WorkerPace measured(double rate, double line) {
  WorkerPace pace;
  for (int i = 0; i < 60; i++) {
    note_sent(pace, 1000, false);
    note_answered(pace, 1000, false, line + 1000 / rate, 0, 1000 / rate);
  }
  return pace;
}

TEST(WorkerBudget, BeginsWithOneSmallOrder) {
  WorkerPace pace;
  EXPECT_EQ(room_for(pace, false), first_order);
  note_sent(pace, first_order, false);
  EXPECT_EQ(room_for(pace, false), 0);
}

TEST(WorkerBudget, CoversTheLineAndALittleMore) {
  const double rate = 100000, line = 0.05;
  const WorkerPace pace = measured(rate, line);
  EXPECT_NEAR(room_for(pace, false), rate * (line + ahead_walking), 0.01 * rate);
  EXPECT_NEAR(room_for(pace, true), rate * (line + ahead_resting), 0.01 * rate);
}

TEST(WorkerBudget, GivesAFasterWorkerMore) {
  EXPECT_GT(room_for(measured(200000, 0.01), false), room_for(measured(50000, 0.01), false));
}

TEST(WorkerBudget, CountsWhatIsOnTheWay) {
  WorkerPace pace = measured(100000, 0);
  const int room = room_for(pace, false);
  note_sent(pace, room, false);
  EXPECT_LE(room_for(pace, false), 1);
  note_answered(pace, room / 2, false, 0.1, 0, 0.5 * room / 100000);
  EXPECT_NEAR(room_for(pace, false), room / 2, 0.02 * room);
}

TEST(WorkerBudget, RestingPicturesLeaveRoomForWalkers) {
  WorkerPace pace = measured(100000, 0);
  note_sent(pace, room_for(pace, true), true);
  EXPECT_LE(room_for(pace, true), 1);
  EXPECT_GT(room_for(pace, false), 10000);
}

TEST(WorkerBudget, GivesWayWhereOrdersWaitBehindOthers) {
  WorkerPace pace = measured(100000, 0.01);
  const int alone = room_for(pace, false);
  for (int i = 0; i < 5; i++) {
    note_sent(pace, 1000, false);
    note_answered(pace, 1000, false, 0.51, 0.49, 0.01);
  }
  EXPECT_LT(room_for(pace, false), alone / 4);
  for (int i = 0; i < 30; i++) {
    note_sent(pace, 1000, false);
    note_answered(pace, 1000, false, 0.02, 0, 0.01);
  }
  EXPECT_NEAR(room_for(pace, false), alone, 0.05 * alone);
}

TEST(WorkerBudget, LostOrdersLeaveNothingOnTheWay) {
  WorkerPace pace = measured(100000, 0.01);
  note_sent(pace, 5000, false);
  const double share = pace.share;
  note_unanswered(pace, 5000, false);
  EXPECT_EQ(pace.in_flight, 0u);
  EXPECT_EQ(pace.urgent, 0u);
  EXPECT_LT(pace.share, share);
  note_unanswered(pace, 5000, false);  // one that nobody sent
  EXPECT_EQ(pace.in_flight, 0u);
}

TEST(WorkerBudget, CallsMeasureTheLine) {
  WorkerPace pace = measured(100000, 0.01);
  for (int i = 0; i < 40; i++) note_called(pace, 0.4);
  EXPECT_NEAR(pace.line, 0.4, 0.01);
  note_called(pace, -3);  // a clock that jumped
  EXPECT_GE(pace.line, 0);
}

}  // namespace
}  // namespace wellspring::test
