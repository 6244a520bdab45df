// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "scan/points.h"

namespace wellspring::test {
using namespace wellspring::scan;

TEST(PointBlock, is_empty_once_cleared) {
  PointBlock block;
  block.place.push_back(dvec3(1));
  block.station.push_back(1);
  block.clear();
  EXPECT_EQ(block.size(), 0u);
  EXPECT_TRUE(block.station.empty());
}

}  // namespace wellspring::test
