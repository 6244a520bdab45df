// SPDX-License-Identifier: Apache-2.0
#include "base/worker.h"

#include <chrono>
#include <future>
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>
#include <thread>
#include <vector>

namespace wellspring::test {
namespace {

TEST(Priority, DoesEachOnce) {
  for (int count : {0, 1, 7, 1000})
    for (int grain : {0, 1, 3, 2000}) {
      std::vector<std::atomic<int>> done(size_t(count) + 1);
      priority_ranges(count, grain, [&](int begin, int end) {
        EXPECT_LE(end - begin, std::max(grain, 1));
        for (int i = begin; i < end; i++) done[size_t(i)]++;
      });
      for (int i = 0; i < count; i++) EXPECT_EQ(done[size_t(i)], 1);
      EXPECT_EQ(done[size_t(count)], 0);
    }
}

// No thread is free, and the other's loop has more to do: it comes before that.
TEST(Priority, ThreadsWithinOtherLoopsComeBetweenTheirPieces) {
  oneapi::tbb::global_control no_more(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  std::promise<void> at_work, begun;
  std::promise<std::thread::id> helped;
  auto helper = helped.get_future();
  std::vector<std::thread::id> high_priority(2);
  std::atomic<bool> in_time{false};
  std::thread other([&] {
    parallel_for(2, [&](int i) {
      if (i == 1)
        in_time = high_priority[0] != std::thread::id() && high_priority[1] != std::thread::id();
      else at_work.set_value(), begun.get_future().wait();
    });
  });
  at_work.get_future().wait();
  std::thread::id here = std::this_thread::get_id();
  priority_ranges(2, 1, [&](int i, int) {
    high_priority[size_t(i)] = std::this_thread::get_id();
    if (std::this_thread::get_id() != here) return helped.set_value(std::this_thread::get_id());
    begun.set_value();
    EXPECT_EQ(helper.wait_for(std::chrono::seconds(600)), std::future_status::ready);
  });
  other.join();
  EXPECT_EQ(high_priority[0], here);
  EXPECT_NE(high_priority[1], here);
  EXPECT_TRUE(in_time);
}

// Several at once, while threads are at work on other loops, as several shows in a program have it.
TEST(Priority, ManyAtATime) {
  std::atomic<bool> end{false};
  std::thread background([&] {
    while (!end) parallel_ranges(64, 1, [](int, int) {});
  });
  std::vector<std::thread> owners;
  for (int owner = 0; owner < 4; owner++)
    owners.emplace_back([owner] {
      for (int round = 0; round < 200; round++) {
        std::vector<int> values(97);
        priority_ranges(97, 5, [&](int begin, int end) {
          for (int i = begin; i < end; i++) values[size_t(i)] += owner + i;
        });
        for (int i = 0; i < 97; i++) ASSERT_EQ(values[size_t(i)], owner + i);
      }
    });
  for (std::thread& owner : owners) owner.join();
  end = true;
  background.join();
}

}  // namespace
}  // namespace wellspring::test
