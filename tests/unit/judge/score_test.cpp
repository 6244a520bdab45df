// SPDX-License-Identifier: Apache-2.0
#include "judge/score.h"

#include <gtest/gtest.h>

namespace wellspring::test {
namespace {

TEST(GestureScore, the_table_of_the_paper_gives_its_percentages) {
  // Elmezain et al. 2009, table 1: tests, inserted, deleted, substituted, correct.
  const SpotCounts table[10] = {{28, 2, 1, 2, 25}, {28, 0, 1, 1, 26}, {28, 0, 0, 2, 26},
                                {28, 0, 0, 0, 28}, {28, 0, 0, 1, 27}, {28, 0, 1, 1, 26},
                                {28, 1, 1, 1, 26}, {28, 0, 0, 0, 28}, {28, 1, 0, 2, 26},
                                {28, 0, 1, 0, 27}};
  const double percent[10] = {83.33, 92.86, 92.86, 100, 96.43, 92.86, 89.66, 100, 89.66, 96.43};
  SpotCounts all;
  for (int i = 0; i < 10; i++) {
    EXPECT_NEAR(100 * reliability(table[i]), percent[i], 0.005) << i;
    all += table[i];
  }
  EXPECT_NEAR(100 * reliability(all), 93.31, 0.005);
  EXPECT_NEAR(100 * recognition_ratio(176, 180), 97.78, 0.005);
}

TEST(GestureScore, nothing_tested_is_nothing_right) {
  EXPECT_EQ(recognition_ratio(0, 0), 0);
  EXPECT_EQ(reliability({}), 0);
}

TEST(GestureScore, each_kind_of_error_is_counted) {
  const std::vector<TrueGesture> truth{{"1", 0, 1}, {"2", 2, 3}, {"3", 4, 5}, {"4", 6, 7}};
  const std::vector<SpottedGesture> spotted{{"1", 0.1, 1.1, 5},   // correct
                                            {"7", 2.1, 2.9, 5},   // another label
                                            {"5", 3.2, 3.8, 5},   // nothing there
                                            {"4", 6.0, 6.5, 5},   // correct ...
                                            {"4", 6.6, 7.0, 5}};  // ... but only once
  const SpotCounts counts = count_spotted(truth, spotted);
  EXPECT_EQ(counts.tests, 4);
  EXPECT_EQ(counts.correct, 2);
  EXPECT_EQ(counts.substituted, 1);
  EXPECT_EQ(counts.deleted, 1);
  EXPECT_EQ(counts.inserted, 2);
}

TEST(GestureScore, a_touch_of_a_gesture_is_not_that_gesture) {
  const std::vector<TrueGesture> truth{{"1", 0, 1}};
  const std::vector<SpottedGesture> spotted{{"1", 0.9, 1.9, 5}};
  const SpotCounts counts = count_spotted(truth, spotted);
  EXPECT_EQ(counts.inserted, 1);
  EXPECT_EQ(counts.deleted, 1);
}

}  // namespace
}  // namespace wellspring::test
