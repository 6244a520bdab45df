// SPDX-License-Identifier: Apache-2.0
#include "plan/shared_cores.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

#include "base/rng.h"
#include "plan/event_queue.h"
#include "plan/tally.h"

namespace wellspring::test {
namespace {

TEST(SharedCores, ATaskAloneTakesItsWorkOverItsWidth) {
  SharedCores cores(4);
  cores.add(7, 3, 2, 10);
  EXPECT_DOUBLE_EQ(cores.next_end(), 11.5);
  EXPECT_EQ(cores.finish(11), -1);
  EXPECT_EQ(cores.finish(11.5), 7);
  EXPECT_EQ(cores.finish(11.5), -1);
  EXPECT_EQ(cores.next_end(), std::numeric_limits<double>::infinity());
  EXPECT_DOUBLE_EQ(cores.used(20), 3);
}

TEST(SharedCores, TasksShareWhatThereIsTooLittleOf) {
  SharedCores cores(1);
  cores.add(1, 1, 1, 0);
  cores.add(2, 1, 1, 0.5);  // by then half of the first is done
  EXPECT_EQ(cores.finish(cores.next_end()), 1);
  EXPECT_NEAR(cores.next_end(), 2, 1e-9);
  EXPECT_EQ(cores.finish(cores.next_end()), 2);
  EXPECT_NEAR(cores.used(5), 2, 1e-9);
}

TEST(SharedCores, OtherProgramsGetAsMuch) {
  SharedCores cores(2, 1);
  cores.add(1, 1, 2, 0);
  EXPECT_DOUBLE_EQ(cores.next_end(), 1);  // half of two cores
  SharedCores some(2, 1);
  some.add(1, 1, 0.5, 0);
  EXPECT_DOUBLE_EQ(some.next_end(), 2);  // it does not want more than its part
}

TEST(SharedCores, ATimedTaskEndsOnTimeAndSlowsOthers) {
  SharedCores cores(2);
  cores.hold(1, 1, 2, 0);
  cores.add(2, 1, 2, 0);
  EXPECT_EQ(cores.finish(1), 1);
  EXPECT_EQ(cores.finish(1), 2);
}

TEST(SharedCores, WidthFollowsAmdahl) {
  EXPECT_DOUBLE_EQ(width_on(8, 0), 8);
  EXPECT_DOUBLE_EQ(width_on(8, 1), 1);
  EXPECT_DOUBLE_EQ(width_on(2, 0.5), 1 / 0.75);
  EXPECT_DOUBLE_EQ(width_on(0.5, 0.5), 0.5);
}

// In M/G/1 with processor sharing the mean time in the system is D / (1 - load), whatever the
// distribution of the work (Kleinrock 1976, section 4.4).
TEST(SharedCores, MeanTimeIsThatOfProcessorSharing) {
  for (const double load : {0.3, 0.7}) {
    constexpr double work = 0.1;
    SharedCores cores(1);
    Rng random(5);
    std::map<int, double> began;
    Tally took;
    double now = 0;
    for (int i = 0; i < 200000; i++) {
      const double next = now - work / load * std::log(1 - double(random.uniform()));
      for (double end; (end = cores.next_end()) < next;)
        if (const int id = cores.finish(end); id >= 0) took.add(end - began[id]), began.erase(id);
      now = next;
      began[i] = now;
      cores.add(i, work, 1, now);
    }
    EXPECT_NEAR(took.mean(), work / (1 - load), 0.03 * work / (1 - load)) << load;
  }
}

TEST(EventQueue, EventsComeByTimeAndThenInTheirOrder) {
  EventQueue<int> events;
  for (const auto& [time, event] : {std::pair(2.0, 1), {1.0, 2}, {2.0, 3}, {1.0, 4}, {0.5, 5}})
    events.push(time, event);
  std::vector<int> order;
  for (double before = 0; !events.empty(); order.push_back(events.pop())) {
    EXPECT_GE(events.next_time(), before);
    before = events.next_time();
  }
  EXPECT_EQ(order, (std::vector<int>{5, 2, 4, 1, 3}));
}

TEST(Tally, QuantilesAreThoseOfTheValues) {
  Tally tally;
  EXPECT_TRUE(std::isnan(tally.quantile(0.5)));
  EXPECT_TRUE(std::isnan(tally.mean()));
  for (int i = 1; i <= 1000; i++) tally.add(i * 1e-3);
  EXPECT_NEAR(tally.quantile(0.5), 0.5, 0.006);
  EXPECT_NEAR(tally.quantile(0.95), 0.95, 0.01);
  EXPECT_DOUBLE_EQ(tally.quantile(1), 1);
  EXPECT_NEAR(tally.mean(), 0.5005, 1e-9);
  Tally more;
  more.add(0), more.add(1e9);
  tally.add(more);
  EXPECT_EQ(tally.count(), 1002u);
  EXPECT_DOUBLE_EQ(tally.longest(), 1e9);
}

}  // namespace
}  // namespace wellspring::test
