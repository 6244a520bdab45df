// SPDX-License-Identifier: Apache-2.0
#include "base/unicode.h"

#include <gtest/gtest.h>

#include <vector>

namespace wellspring::test {
namespace {

const std::vector<std::string> known = {"hall", "crown", "point_far", "Lamp Crown", "well", ""};

TEST(NearName, NamesWhatWasProbablyMeant) {
  EXPECT_EQ(did_you_mean("crwon", known), "; did you mean 'crown'?");
  EXPECT_EQ(did_you_mean("point_fra", known), "; did you mean 'point_far'?");
  EXPECT_EQ(did_you_mean("lamp crown", known), "; did you mean 'Lamp Crown'?");
  EXPECT_EQ(did_you_mean("Hall", known), "; did you mean 'hall'?");
  EXPECT_EQ(did_you_mean("wells", known), "; did you mean 'well'?");
}

TEST(NearName, SaysNothingWhereNothingIsNear) {
  EXPECT_EQ(did_you_mean("fireplace", known), "");
  EXPECT_EQ(did_you_mean("", known), "");
  EXPECT_EQ(did_you_mean("x", known), "");
  EXPECT_EQ(did_you_mean("crown", {}), "");
  EXPECT_EQ(did_you_mean(std::string(100000, 'c'), known), "");
}

TEST(NearName, ListsHaveAnEnd) {
  EXPECT_EQ(list_names(known, 2), "hall, crown and 4 more");
  EXPECT_EQ(list_names(std::vector<std::string>{"a", "b"}), "a, b");
  EXPECT_EQ(list_names({}), "");
}

}  // namespace
}  // namespace wellspring::test
