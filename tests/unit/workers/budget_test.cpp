// SPDX-License-Identifier: Apache-2.0
// How much a worker is sent follows from what was measured of it.
#include "workers/budget.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

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

int total(const std::vector<OrderPlan>& plan) {
  return std::accumulate(plan.begin(), plan.end(), 0,
                         [](int sum, const OrderPlan& one) { return sum + one.requests; });
}

TEST(ShareOut, GivesWhoHasMostRoomTheMost) {
  const std::vector<OrderPlan> plan = share_out(std::vector{1000, 5000, 63, 0}, 4000);
  EXPECT_EQ(total(plan), 4000);
  for (const OrderPlan& one : plan) EXPECT_EQ(one.worker, 1u);  // its room stays the largest
}

TEST(ShareOut, StaysWithinEachRoomAndWithinWhatThereIs) {
  const std::vector<int> rooms{700, 300, 100, 64, 0, 10};
  std::vector<int> given(rooms.size());
  for (const OrderPlan& one : share_out(rooms, 100000)) given[one.worker] += one.requests;
  for (size_t i = 0; i < rooms.size(); i++) {
    EXPECT_LE(given[i], rooms[i]);
    EXPECT_GT(given[i], rooms[i] - least_order);
  }
  EXPECT_LE(total(share_out(rooms, 500)), 500);
  EXPECT_TRUE(share_out(rooms, least_order - 1).empty());
  EXPECT_TRUE(share_out({}, 500).empty());
}

// A thousand workers, each with its own speed and line, on a clock that the test turns: what is
// sent them, what they have before them, and what comes back.
class ThousandWorkers {
 public:
  static constexpr double step = 0.02, span = 20;  // seconds
  struct Order {
    double sent = 0, arrives = 0, begins = 0, ends = 0;
    int requests = 0;
  };
  struct Worker {
    double rate = 0, line = 0;  // samples a second; seconds one way
    double free_at = 0, idle = 0;
    bool dead = false;
    WorkerPace pace;
    std::vector<Order> orders;
  };
  std::vector<Worker> workers{1000};
  double now = 0;
  uint64_t sent = 0, answered = 0, lost = 0;

  ThousandWorkers() {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> speed(20e3, 200e3), delay(0.0005, 0.2);
    for (Worker& one : workers) one.rate = speed(random), one.line = delay(random);
  }
  void run(double seconds) {
    for (const double end = now + seconds; now < end; now += step) advance();
  }
  uint64_t on_the_way() const {
    return std::accumulate(
        workers.begin(), workers.end(), uint64_t(0),
        [](uint64_t sum, const Worker& one) { return sum + one.pace.in_flight; });
  }

 private:
  void advance() {
    for (Worker& one : workers) {
      std::erase_if(one.orders, [&](const Order& order) { return land(one, order); });
    }
    std::vector<int> rooms;
    for (const Worker& one : workers) rooms.push_back(room_for(one.pace, true));
    for (const OrderPlan& plan : share_out(rooms, 1 << 26)) {
      Worker& one = workers[plan.worker];
      Order order{now, now + one.line, 0, 0, plan.requests};
      order.begins = std::max(order.arrives, one.free_at);
      order.ends = order.begins + plan.requests / one.rate;
      if (now > span / 2) one.idle += order.begins - std::max(one.free_at, span / 2);
      one.free_at = order.ends;
      note_sent(one.pace, plan.requests, true);
      sent += uint64_t(plan.requests);
      one.orders.push_back(order);
    }
  }
  bool land(Worker& one, const Order& order) {
    if (one.dead) {
      if (now < order.sent + 2 + one.pace.line) return false;
      lost += uint64_t(order.requests);
      note_unanswered(one.pace, order.requests, true);
      return true;
    }
    const double came = order.ends + one.line;
    if (now < came) return false;
    answered += uint64_t(order.requests);
    note_answered(one.pace, order.requests, true, now - order.sent, order.begins - order.arrives,
                  order.ends - order.begins);
    return true;
  }
};

TEST(ThousandWorkers, AllAreBusyAndNoneHasMoreThanItCanDoSoon) {
  ThousandWorkers all;
  all.run(ThousandWorkers::span);
  double idle = 0;
  for (const auto& one : all.workers) {
    idle += one.idle;
    EXPECT_LE(double(one.pace.in_flight), 1.1 * one.rate * (2 * one.line + ahead_resting) + 2048);
  }
  EXPECT_LT(idle / double(all.workers.size()), 0.02 * ThousandWorkers::span / 2);
  EXPECT_EQ(all.sent, all.answered + all.lost + all.on_the_way());
  EXPECT_EQ(all.lost, 0u);
}

TEST(ThousandWorkers, ThoseThatDieTakeOnlyTheirOwnShare) {
  ThousandWorkers all;
  all.run(5);
  uint64_t theirs = 0;
  for (size_t i = 0; i < all.workers.size(); i += 10) {
    all.workers[i].dead = true;
    theirs += all.workers[i].pace.in_flight;
  }
  std::vector<double> shares;
  for (const auto& one : all.workers) shares.push_back(one.pace.share);
  all.run(6);
  EXPECT_GE(all.lost, theirs);
  EXPECT_EQ(all.sent, all.answered + all.lost + all.on_the_way());
  for (size_t i = 0; i < all.workers.size(); i++) {
    if (all.workers[i].dead) EXPECT_LT(all.workers[i].pace.share, 0.5 * shares[i]);
    else EXPECT_GE(all.workers[i].pace.share, shares[i]);
  }
}

}  // namespace
}  // namespace wellspring::test
