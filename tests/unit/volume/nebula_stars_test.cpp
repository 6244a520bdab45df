// SPDX-License-Identifier: Apache-2.0
#include "volume/nebula/stars.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "unit/volume/nebula_pictures.h"

namespace wellspring::test {
namespace {

struct Star {
  double x, y, size, light;
};
const std::vector<Star> stars{{20.3, 22.1, 1.0, 0.8},   {100.5, 30.5, 0.8, 0.4},
                              {64.2, 40.7, 1.2, 2.0},   {30.0, 90.4, 1.0, 0.6},
                              {110.6, 105.2, 1.4, 1.5}, {70.1, 70.3, 1.0, 5.0}};

void add_star(image::LinearImage& picture, const Star& star) {
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const double away = std::hypot(x + 0.5 - star.x, y + 0.5 - star.y) / star.size;
      picture.color[size_t(y * picture.width + x)] +=
          vec3(float(star.light * std::exp(-0.5 * away * away)));
    }
}

TEST(NebulaStars, KnownStarsGoAndTheNebulaStays) {
  const image::LinearImage nebula = soft_ellipse(128, 128, 0.4, 30, 18);
  image::LinearImage picture = nebula;
  for (const Star& star : stars) add_star(picture, star);
  const StarReport report = clean_sky(picture, true, {.radius = 6});
  EXPECT_EQ(report.stars, int(stars.size()));
  for (const Star& star : stars)
    EXPECT_EQ(report.mask[size_t(star.y) * 128 + size_t(star.x)], 1) << star.x;
  EXPECT_LT(report.pixels, 128 * 128 / 10);
  double most = 0;
  for (size_t i = 0; i < nebula.color.size(); ++i)
    most = std::max(most, std::abs(double(picture.color[i].x - nebula.color[i].x)));
  EXPECT_LT(most, 0.08);
}

TEST(NebulaStars, ANebulaWithoutStarsIsLeftAlone) {
  const image::LinearImage nebula = soft_ellipse(128, 96, 1.1, 25, 9);
  image::LinearImage picture = nebula;
  const StarReport report = clean_sky(picture, true);
  EXPECT_EQ(report.stars, 0);
  for (size_t i = 0; i < nebula.color.size(); ++i)
    EXPECT_NEAR(picture.color[i].y, nebula.color[i].y, 1e-5);
}

TEST(NebulaStars, TheSkyIsTakenOff) {
  image::LinearImage picture = soft_ellipse(64, 64, 0, 10, 8);
  for (vec3& color : picture.color) color += vec3(0.1f, 0.2f, 0.05f);
  const StarReport report = clean_sky(picture, false);
  EXPECT_NEAR(report.sky.y, 0.2f, 1e-4);
  EXPECT_NEAR(picture.color[0].y, 0, 1e-4);
  EXPECT_NEAR(picture.color[32 * 64 + 32].x, 1, 0.02);
}

TEST(NebulaStars, LightThatIsNoNumberBecomesNone) {
  const float infinite = std::numeric_limits<float>::infinity();
  image::LinearImage picture{
      4, 1, {{std::nanf(""), 1, 1}, {infinite, 1, 2}, {-3, 1, 1}, {1, 1, 1}}};
  clean_sky(picture, true);
  for (const vec3 color : picture.color)
    for (int c = 0; c < 3; ++c) EXPECT_TRUE(color[c] >= 0 && color[c] < 3);
}

TEST(NebulaStars, TinyAndBlackPicturesAreTaken) {
  for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(1, 7), glm::ivec2(3, 2)}) {
    image::LinearImage picture{size.x, size.y, std::vector<vec3>(size_t(size.x * size.y))};
    EXPECT_EQ(clean_sky(picture, true).stars, 0);
    picture.color[0] = vec3(1);
    clean_sky(picture, true);
  }
}

TEST(NebulaStars, CodesBecomeLinearLight) {
  image::ImageCodes codes{2, 1, {255, 188, 0, 255, 255, 255, 255, 0}, {}};
  const image::LinearImage picture = linearise(codes);
  EXPECT_FLOAT_EQ(picture.color[0].x, 1);
  EXPECT_NEAR(picture.color[0].y, 0.5, 0.005);
  EXPECT_EQ(picture.color[1], vec3(0));
  codes = {1, 1, {}, {65535, 32768, 0, 65535}};
  EXPECT_NEAR(linearise(codes).color[0].y, 0.214, 0.001);
}

TEST(NebulaStars, ShrinkingKeepsTheMean) {
  const image::LinearImage picture{3, 2, {vec3(1), vec3(2), vec3(9), vec3(3), vec3(6), vec3(5)}};
  const image::LinearImage small = shrink(picture, 2);
  EXPECT_EQ(small.width, 2);
  EXPECT_EQ(small.height, 1);
  EXPECT_EQ(small.color, (std::vector<vec3>{vec3(3), vec3(7)}));
}

}  // namespace
}  // namespace wellspring::test
