// SPDX-License-Identifier: Apache-2.0
#include "kiosk/face/face_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace wellspring::test {
namespace {

Box at(float x, float width = 100) { return {x - width / 2, 100, width, width}; }

FacePath walked(float pace) {
  FacePath path;
  for (int k = 0; k <= 20; k++) add_place(path, 0.1 * k, at(pace * 0.1f * float(k)));
  return path;
}

TEST(FacePath, WhoWalksIsSoughtAhead) {
  const FacePath path = walked(200);
  EXPECT_NEAR(predict(path, 2.3).center_x(), 460, 4);
  EXPECT_NEAR(predict(path, 60).center_x(), 500, 6) << "no pace is believed for long";
  EXPECT_LT(*misfit(path, 2.3, at(460)), 0.05f);
  EXPECT_LT(*misfit(path, 2.1, at(430)), 0.5f);
  EXPECT_FALSE(misfit(path, 2.1, at(300)));
}

TEST(FacePath, FacesOfAnotherSizeAreOthers) {
  const FacePath path = walked(0);
  EXPECT_TRUE(misfit(path, 2.1, at(0, 115)));
  EXPECT_FALSE(misfit(path, 2.1, at(0, 140)));
  EXPECT_FALSE(misfit(path, 2.1, at(0, 70)));
  EXPECT_TRUE(misfit(path, 3, at(0, 140))) << "after a gap it may have come nearer";
}

TEST(FacePath, TimesThatRunBackwardsAndBoxesWithoutSizeAreTaken) {
  FacePath path = walked(100);
  add_place(path, -5, at(10));
  EXPECT_EQ(path.time, -5);
  EXPECT_TRUE(std::isfinite(predict(path, -6).x));
  EXPECT_FALSE(misfit(path, 0, {}));
  EXPECT_FALSE(misfit(FacePath{}, 0, at(0)));
  EXPECT_FALSE(misfit(path, 0, at(std::numeric_limits<float>::quiet_NaN())));
}

}  // namespace
}  // namespace wellspring::test
