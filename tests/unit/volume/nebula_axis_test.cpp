// SPDX-License-Identifier: Apache-2.0
#include "volume/nebula/axis.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/volume/nebula_pictures.h"

namespace wellspring::test {
namespace {

TEST(NebulaAxis, TheAxisOfAnEllipseIsFoundWithinADegree) {
  for (const double angle : {-80.0, -45.0, -10.0, 0.0, 17.0, 30.0, 60.0, 89.0}) {
    const PictureAxis axis = propose_axis(soft_ellipse(160, 120, angle * degree, 26, 17));
    EXPECT_NEAR(axis.angle / degree, angle, 1) << angle;
    EXPECT_NEAR(axis.centre.x, 80, 0.1);
    EXPECT_NEAR(axis.centre.y, 60, 0.1);
  }
}

TEST(NebulaAxis, PlacesAreMeasuredAlongTheAxis) {
  const PictureAxis axis{{10, 10}, 90 * degree};
  const glm::dvec2 above = axis.along_and_beside({10, 4});
  EXPECT_NEAR(above.x, 6, 1e-9);
  EXPECT_NEAR(above.y, 0, 1e-9);
  EXPECT_NEAR(std::abs(axis.along_and_beside({13, 10}).y), 3, 1e-9);
}

TEST(NebulaAxis, ARoundOrBlackPictureHasAnAxis) {
  const PictureAxis round = propose_axis(soft_ellipse(64, 64, 0.3, 9, 9));
  EXPECT_TRUE(std::isfinite(round.angle));
  const PictureAxis black = propose_axis({5, 3, std::vector<vec3>(15)});
  EXPECT_EQ(black.angle, 0);
  EXPECT_EQ(black.centre, glm::dvec2(2.5, 1.5));
}

TEST(NebulaAxis, ATiltedDiscTellsItsTilt) {
  for (const double tilt : {15.0, 30.0, 45.0}) {
    // A disc round the axis is as much shorter along it as the tilt's sine says.
    const double angle = 25;
    const image::LinearImage disc =
        soft_ellipse(200, 200, (angle + 90) * degree, 40, 40 * std::sin(tilt * degree));
    const auto proposed = propose_tilt(disc, {{100, 100}, angle * degree});
    ASSERT_TRUE(proposed.has_value());
    EXPECT_NEAR(*proposed / degree, tilt, 3);
  }
  EXPECT_FALSE(propose_tilt(soft_ellipse(100, 100, 0, 25, 12), {{50, 50}, 0}).has_value());
  EXPECT_FALSE(propose_tilt({4, 4, std::vector<vec3>(16)}, {{2, 2}, 0}).has_value());
}

TEST(NebulaAxis, TheExtentHoldsTheLight) {
  image::LinearImage picture{40, 30, std::vector<vec3>(1200)};
  for (int y = 10; y < 20; ++y)
    for (int x = 5; x < 35; ++x) picture.color[size_t(y * 40 + x)] = vec3(1);
  const glm::dvec2 extent = light_extent(picture, {{20, 15}, 0}, 1);
  EXPECT_NEAR(extent.x, 15, 1e-9);
  EXPECT_NEAR(extent.y, 5, 1e-9);
  EXPECT_EQ(light_extent({2, 2, std::vector<vec3>(4)}, {{1, 1}, 0}, 1), glm::dvec2(0.5));
}

}  // namespace
}  // namespace wellspring::test
