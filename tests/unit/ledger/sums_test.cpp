// SPDX-License-Identifier: Apache-2.0
// Days as texts, and sums as a table.
#include "base/layers.h"
#include "ledger/sums.h"

#include <gtest/gtest.h>

namespace wellspring::test {
namespace {

TEST(Sums, DaysAreReadAsTheyAreWritten) {
  EXPECT_EQ(day_text(0), "1970-01-01");
  EXPECT_EQ(day_text(19783), "2024-03-01");
  EXPECT_EQ(day_text(19782), "2024-02-29");
  for (int64_t day : {-1, 0, 19782, 20000, 40000}) EXPECT_EQ(parse_day(day_text(day)), day);
  for (const char* wrong : {"", "2023-02-29", "2024-13-01", "2024-1-1", "24-01-01", "2024-01-00",
                            "2024/01/01", "2024-01-01 ", "2024-0a-01", "-024-01-01"})
    EXPECT_FALSE(parse_day(wrong)) << wrong;
}

TEST(Sums, ATableHasOneLineForEach) {
  Sums sums{{{0, "visits", "castle"}, 3},
            {{0, "dwell_seconds", "castle/door"}, 12.3456},
            {{1, "visits", "castle"}, 1}};
  EXPECT_EQ(write_csv(sums),
            "day,what,key,value\r\n1970-01-01,dwell_seconds,castle/door,12.3\r\n"
            "1970-01-01,visits,castle,3\r\n1970-01-02,visits,castle,1\r\n");
  EXPECT_EQ(write_csv({}), "day,what,key,value\r\n");
}

TEST(Sums, TextsStayInTheirCellsAndAreNoFormulas) {
  Sums sums{{{0, "languages", "a,\"b\"\n"}, 1}, {{0, "languages", "=1+1"}, 1}};
  EXPECT_EQ(write_csv(sums),
            "day,what,key,value\r\n1970-01-01,languages,'=1+1,1\r\n"
            "1970-01-01,languages,\"a,\"\"b\"\"\n\",1\r\n");
}

TEST(Sums, AreAdded) {
  Sums sums{{{0, "visits", "castle"}, 3}};
  add(sums, {{{0, "visits", "castle"}, 2}, {{1, "visits", "castle"}, 4}});
  EXPECT_EQ(sums, (Sums{{{0, "visits", "castle"}, 5}, {{1, "visits", "castle"}, 4}}));
}

}  // namespace
}  // namespace wellspring::test
