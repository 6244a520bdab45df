// SPDX-License-Identifier: Apache-2.0
// What the line about long work says.
#include "base/clock.h"

#include <gtest/gtest.h>

namespace wellspring::test {
namespace {

TEST(Progress, TellsWhatIsDoneAndWhatIsLeft) {
  EXPECT_EQ(progress_line("render", 1 / 3.0, 20),
            "render [##########....................] 33 %, 0:40 left");
  EXPECT_EQ(progress_line("bake", 0.5, 30, "12 passes, error 4.0 %"),
            "bake [###############...............] 50 %, 0:30 left, 12 passes, error 4.0 %");
  EXPECT_EQ(progress_line("bench", 0.1, 720),
            "bench [###...........................] 10 %, 1:48:00 left");
  EXPECT_EQ(progress_line("clip", 1, 5), "clip [##############################] 100 %, 0:00 left");
}

TEST(Progress, GuessesNothingFromNothing) {
  EXPECT_EQ(progress_line("render", 0, 0), "render [..............................] 0 %");
  EXPECT_EQ(progress_line("render", 0, 60), "render [..............................] 0 %");
  EXPECT_EQ(progress_line("render", 0.5, 1), "render [###############...............] 50 %")
      << "a second tells little";
  EXPECT_EQ(progress_line("render", 1e-9, 60), "render [..............................] 0 %")
      << "years are no estimate";
}

TEST(Progress, StaysInItsBounds) {
  EXPECT_EQ(progress_line("x", -1, 0), progress_line("x", 0, 0));
  EXPECT_EQ(progress_line("x", 7, 5), progress_line("x", 1, 5));
}

// The tests' own stderr is that of whoever runs them: here a file.
TEST(Progress, IsQuietWhereThereIsNoTerminal) {
  testing::internal::CaptureStderr();
  {
    Progress quiet("render");
    quiet.tell(0.5);
    quiet.clear();
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  testing::internal::CaptureStderr();
  {
    Progress spoken("bake", 10);
    spoken.tell(0.5);
    spoken.tell(0.6);  // too soon
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "bake [###############...............] 50 %\n");
}

}  // namespace
}  // namespace wellspring::test
