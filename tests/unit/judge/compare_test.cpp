// SPDX-License-Identifier: Apache-2.0
#include "judge/compare.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace wellspring::test {
namespace {

Frame flat(int width, int height, vec3 color) {
  Frame frame{.width = width, .height = height};
  frame.color.assign(size_t(width * height), color);
  return frame;
}

TEST(Compare, KnownDifferences) {
  Frame reference = flat(2, 2, vec3(1)), test = reference;
  EXPECT_EQ(rmse(test, reference), 0);
  EXPECT_EQ(relative_mse(test, reference), 0);
  test.color[0] = vec3(3, 1, 1);  // one channel of twelve off by 2
  EXPECT_NEAR(rmse(test, reference), std::sqrt(4.0 / 12), 1e-12);
  EXPECT_NEAR(relative_mse(test, reference), 4.0 / 3 / 1.01 / 4, 1e-6);
}

TEST(Compare, RelativeErrorDoesNotDependOnBrightness) {
  double dim = relative_mse(flat(3, 3, vec3(11)), flat(3, 3, vec3(10)));
  double bright = relative_mse(flat(3, 3, vec3(1100)), flat(3, 3, vec3(1000)));
  EXPECT_NEAR(dim, bright, 1e-5);
}

TEST(Compare, DifferentSizesAreAnError) {
  EXPECT_THROW(rmse(flat(2, 3, vec3(0)), flat(3, 2, vec3(0))), std::invalid_argument);
  EXPECT_THROW(relative_mse(Frame{}, Frame{}), std::invalid_argument);
}

}  // namespace
}  // namespace wellspring::test
