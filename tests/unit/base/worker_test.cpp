// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <future>

#include "base/worker.h"

namespace wellspring::test {
namespace {

TEST(Worker, DoesOneThingAfterTheOther) {
  int sum = 0;
  Worker worker;
  EXPECT_FALSE(worker.busy());
  for (int i = 1; i <= 100; i++) worker.run([&sum, i] { sum = 2 * sum % 1009 + i; });
  worker.wait();
  int expected = 0;
  for (int i = 1; i <= 100; i++) expected = 2 * expected % 1009 + i;
  EXPECT_EQ(sum, expected);
  EXPECT_FALSE(worker.busy());
}

TEST(Worker, GoesOnMeanwhile) {
  std::promise<void> begun, end;
  Worker worker;
  worker.run([&] {
    begun.set_value();
    end.get_future().wait();
  });
  begun.get_future().wait();
  EXPECT_TRUE(worker.busy());
  EXPECT_FALSE(worker.wait_for(0.001));
  end.set_value();
  EXPECT_TRUE(worker.wait_for(600));
}

TEST(Worker, EndsWithItsWork) {
  bool done = false;
  {
    Worker worker;
    worker.run([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      done = true;
    });
  }
  EXPECT_TRUE(done);
  Worker never_used;
}

}  // namespace
}  // namespace wellspring::test
