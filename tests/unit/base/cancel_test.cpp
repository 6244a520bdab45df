// SPDX-License-Identifier: Apache-2.0
#include "base/worker.h"

#include <gtest/gtest.h>

#include <thread>

namespace wellspring::test {
namespace {

TEST(Cancel, NothingIsCancelledWithoutAScope) { EXPECT_NO_THROW(check_cancelled()); }

TEST(Cancel, EndsWhatIsDoneWithinTheScope) {
  std::stop_source outer, inner;
  {
    const CancelScope scope(outer.get_token());
    EXPECT_NO_THROW(check_cancelled());
    outer.request_stop();
    EXPECT_THROW(check_cancelled(), Cancelled);
    {
      const CancelScope other(inner.get_token());
      EXPECT_NO_THROW(check_cancelled()) << "the innermost says";
      inner.request_stop();
      EXPECT_TRUE(cancel_token().stop_requested());
    }
    EXPECT_THROW(check_cancelled(), Cancelled) << "the outer one says again";
  }
  EXPECT_NO_THROW(check_cancelled());
}

TEST(Cancel, OtherThreadsGoOn) {
  std::stop_source source;
  const CancelScope scope(source.get_token());
  source.request_stop();
  bool went_on = false;
  std::thread([&] {
    check_cancelled();
    went_on = true;
  }).join();
  EXPECT_TRUE(went_on);
}

}  // namespace
}  // namespace wellspring::test
