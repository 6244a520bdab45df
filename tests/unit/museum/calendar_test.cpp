// SPDX-License-Identifier: Apache-2.0
#include "base/layers.h"
#include "museum/upkeep.h"

#include <gtest/gtest.h>

namespace wellspring::test {
namespace {

constexpr std::time_t noon = 1780000000, day = 86400, year = 365 * day;

TEST(Calendar, BelievesAClockThatGoesOnAndIsSetByLessThanADay) {
  Calendar calendar;
  EXPECT_EQ(calendar.see(noon, 5), noon);
  EXPECT_EQ(calendar.see(noon + 3600, 3605), noon + 3600);
  EXPECT_EQ(calendar.see(noon + 10, 3606), noon + 10) << "set back by an hour";
  EXPECT_EQ(calendar.see(noon + day - 60, 3607), noon + day - 60);
  EXPECT_FALSE(calendar.doubts());
}

TEST(Calendar, GoesOnAsItWasWhereTheClockLeapsAndComesBack) {
  for (const std::time_t leap : {10 * year, -3 * year, 2 * day, -2 * day}) {
    Calendar calendar;
    calendar.see(noon, 0);
    EXPECT_EQ(calendar.see(noon + leap + 60, 60), noon + 60) << leap;
    EXPECT_TRUE(calendar.doubts());
    EXPECT_EQ(calendar.see(noon + leap + 3600, 3600), noon + 3600) << leap;
    EXPECT_EQ(calendar.see(noon + 3601, 3601), noon + 3601) << leap;
    EXPECT_FALSE(calendar.doubts());
    EXPECT_EQ(calendar.see(noon + leap + 3700, 3700), noon + 3700) << "a new leap is a new doubt";
  }
}

TEST(Calendar, BelievesALeapThatStays) {
  Calendar calendar;
  calendar.see(noon, 0);
  const std::time_t set = noon + 10 * year;
  for (int second = 1; second <= 3600; second++)
    EXPECT_EQ(calendar.see(set + second, second), noon + second);
  EXPECT_EQ(calendar.see(set + 3601, 3601), set + 3601);
  EXPECT_EQ(calendar.see(set + 3602, 3602), set + 3602);
}

TEST(Calendar, NeverBelievesAClockThatLeapsAllTheTimeOrWasNeverSet) {
  Calendar calendar;
  EXPECT_EQ(calendar.see(100, 0), 100) << "there is nothing else";
  calendar.see(noon, 1);
  for (int second = 2; second < 20000; second++) {
    EXPECT_EQ(calendar.see(second % 2 ? 100 : noon + second * 3 * day, second), noon + second - 1);
  }
}

}  // namespace
}  // namespace wellspring::test
