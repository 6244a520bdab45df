// SPDX-License-Identifier: Apache-2.0
#include "world/sky.h"

#include <gtest/gtest.h>

#include <cmath>

namespace wellspring::test {
namespace {

vec3 eval_sun_irradiance(const SkySettings& settings) {
  return eval_daylight(settings, std::array{settings.elevation})[0].sun;
}

struct Sky {
  Scene scene;
  explicit Sky(const SkySettings& settings) { add_sky(settings, scene); }
  const Image& image() const { return scene.images[size_t(scene.environment.image)]; }
  // Degrees over the horizon, and clockwise from -Z.
  vec3 at(double elevation, double azimuth) const {
    int y = std::min(int((90 - elevation) / 180 * image().height), image().height - 1);
    int x = int(std::fmod(azimuth / 360 + 0.5, 1.0) * image().width);
    return vec3(image().texels[size_t(y * image().width + x)]);
  }
  vec3 irradiance() const {  // the sky's alone, on level ground
    dvec3 sum(0);
    for (int y = 0; y < image().height / 2; y++)
      for (int x = 0; x < image().width; x++) {
        double theta = 3.14159265 * (y + 0.5) / image().height;
        double solid =
            std::sin(theta) * 2 * 3.14159265 * 3.14159265 / (image().width * image().height);
        sum +=
            dvec3(vec3(image().texels[size_t(y * image().width + x)])) * (std::cos(theta) * solid);
      }
    return vec3(sum);
  }
};

TEST(Sky, ANoonHasTheLightThatIsMeasuredOutdoors) {
  SkySettings noon{60, 180, 2.5, 1};
  Sky sky(noon);
  float sun = luminance(eval_sun_irradiance(noon)) * std::sin(glm::radians(60.0f));
  float diffuse = luminance(sky.irradiance());
  EXPECT_GT(sun + diffuse, 8) << "80,000 lux";
  EXPECT_LT(sun + diffuse, 11.5f) << "no more than outside the air";
  EXPECT_GT(diffuse, 0.08f * (sun + diffuse));  // clear skies give a tenth to a fifth
  EXPECT_LT(diffuse, 0.30f * (sun + diffuse));
  vec3 zenith = sky.at(85, 0);
  EXPECT_GT(zenith.z, 2 * zenith.x) << "blue";
  EXPECT_GT(luminance(sky.at(3, 0)), 1.2f * luminance(zenith)) << "brighter at the horizon";
}

TEST(Sky, ALowSunIsRedAndDimAndTheSkyBrightestRoundIt) {
  SkySettings low{2, 90, 3, 1};
  Sky sky(low);
  vec3 sun = eval_sun_irradiance(low);
  EXPECT_GT(sun.x, 2 * sun.y);
  EXPECT_GT(sun.y, 2 * sun.z);
  EXPECT_LT(luminance(sun), 0.3f * luminance(eval_sun_irradiance({60, 90, 3, 1})));
  EXPECT_GT(luminance(sky.at(5, 90)), 3 * luminance(sky.at(5, 270)));
  vec3 near_sun = sky.at(4, 90);
  EXPECT_GT(near_sun.x, near_sun.z);
}

TEST(Sky, MoreHazeLessSunAndWhiterSky) {
  SkySettings clear{45, 0, 1.5, 1}, hazy{45, 0, 8, 1};
  Sky a(clear), b(hazy);
  EXPECT_GT(luminance(eval_sun_irradiance(clear)), 1.5f * luminance(eval_sun_irradiance(hazy)));
  EXPECT_LT(luminance(a.irradiance()), luminance(b.irradiance()));
  vec3 x = a.at(60, 180), y = b.at(60, 180);
  EXPECT_GT(x.z / x.x, y.z / y.x);
}

TEST(Sky, TheDiscStandsWhereItIsAskedForAndHasTheSunsSize) {
  SkySettings s{30, 90, 2, 3};
  Sky sky(s);
  const SunDisc& sun = sky.scene.environment.sun;
  EXPECT_NEAR(length(sun.direction), 1, 1e-5f);
  EXPECT_NEAR(sun.direction.y, 0.5f, 1e-5f);
  EXPECT_NEAR(sun.direction.x, std::sqrt(0.75f), 1e-5f);  // east
  EXPECT_NEAR(sun.angular_radius * 2, glm::radians(0.53f), 1e-6f);
  double solid = 2 * 3.14159265358979 * (1 - std::cos(double(sun.angular_radius)));
  EXPECT_NEAR(luminance(sun.radiance) * solid, luminance(eval_sun_irradiance(s)), 1e-3);
  EXPECT_NEAR(luminance(eval_sun_irradiance(s)), 3 * luminance(eval_sun_irradiance({30, 90, 2, 1})),
              1e-4f);
}

TEST(Sky, BelowTheHorizonThereIsTwilightWithoutASun) {
  Sky half({0, 90, 2, 1}), set({-1, 90, 2, 1}), night({-18, 90, 2, 1});
  EXPECT_GT(half.scene.environment.sun.angular_radius, 0);
  EXPECT_EQ(set.scene.environment.sun.angular_radius, 0);
  EXPECT_GT(luminance(set.irradiance()), 0.001f);
  EXPECT_LT(luminance(night.irradiance()), 0.01f * luminance(set.irradiance()));
}

TEST(Sky, EverywhereFiniteAndSymmetricAboutTheSun) {
  for (SkySettings s :
       {SkySettings{90, 0, 1, 1}, {0, 10, 10, 1}, {-18, 0, 1, 1}, {10, 180, 1, 0}}) {
    EXPECT_EQ(sky_problem(s), nullptr);
    Sky sky(s);
    for (const vec4& texel : sky.image().texels) {
      ASSERT_TRUE(is_finite(vec3(texel)));
      ASSERT_GE(std::min({texel.x, texel.y, texel.z}), 0);
    }
  }
  Sky sky({20, 180, 2, 1});
  for (double away : {10.0, 50.0, 100.0})
    EXPECT_NEAR(luminance(sky.at(30, 180 - away)) / luminance(sky.at(30, 180 + away)), 1, 0.02);
}

TEST(Sky, WhatMakesNoSenseIsSaid) {
  double nan = std::nan("");
  for (SkySettings s : {SkySettings{91, 0, 2, 1},
                        {-19, 0, 2, 1},
                        {nan, 0, 2, 1},
                        {0, nan, 2, 1},
                        {0, 0, 0.5, 1},
                        {0, 0, 2, -1},
                        {0, 0, nan, 1}})
    EXPECT_NE(sky_problem(s), nullptr);
}

}  // namespace
}  // namespace wellspring::test
