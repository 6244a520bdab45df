// SPDX-License-Identifier: Apache-2.0
#include "base/shard.h"

#include <gtest/gtest.h>

namespace wellspring::test {
namespace {

TEST(Shard, IsReadFromWords) {
  EXPECT_EQ(parse_shard("1/3")->index, 0);
  EXPECT_EQ(parse_shard("3/3")->index, 2);
  EXPECT_EQ(parse_shard("0/3")->index, 2);  // array jobs count from 0
  EXPECT_EQ(to_text(*parse_shard("2/3")), "2/3");
  EXPECT_TRUE(parse_shard("1/1")->is_whole());
  for (const char* text :
       {"", "1", "1/", "/3", "4/3", "-1/3", "1/0", "1/3x", "a/3", "1/5000", "1//3"})
    EXPECT_FALSE(parse_shard(text)) << text;
}

TEST(Shard, EachPieceHasOne) {
  for (const size_t pieces : {0, 1, 7, 8, 9, 100})
    for (int count = 1; count <= 9; count++) {
      size_t every = 0, end = 0;
      for (int i = 0; i < count; i++) {
        const Shard shard{i, count};
        const auto [first, last] = shard.stretch(pieces);
        EXPECT_EQ(first, end);
        end = last;
        for (size_t piece = 0; piece < pieces; piece++) every += shard.has(piece);
      }
      EXPECT_EQ(end, pieces);
      EXPECT_EQ(every, pieces);
    }
}

}  // namespace
}  // namespace wellspring::test
