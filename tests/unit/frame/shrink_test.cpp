// SPDX-License-Identifier: Apache-2.0
#include "frame/tiles.h"

#include <gtest/gtest.h>

namespace wellspring::test {
namespace {

Image8 noise(int width, int height) {
  Image8 image{width, height, std::vector<uint8_t>(size_t(width) * size_t(height) * 3)};
  uint32_t state = 7;
  for (uint8_t& value : image.rgb) value = uint8_t((state = state * 1664525 + 1013904223) >> 24);
  return image;
}

TEST(Shrink, TheSameSizeIsTheSamePicture) {
  const Image8 image = noise(37, 21);
  EXPECT_EQ(shrink(image, 37, 21).rgb, image.rgb);
}

TEST(Shrink, AHalfIsTheMeanOfFour) {
  const Image8 image = noise(16, 8), small = shrink(image, 8, 4);
  for (size_t y = 0; y < 4; y++)
    for (size_t x = 0; x < 8; x++) {
      int sum = 0;
      for (size_t i = 0; i < 4; i++)
        sum += image.rgb[((2 * y + i / 2) * 16 + 2 * x + i % 2) * 3 + 1];
      EXPECT_NEAR(small.rgb[(y * 8 + x) * 3 + 1], sum / 4.0, 0.51);
    }
}

TEST(Shrink, EvenColoursStayAsTheyAre) {
  for (int width : {1, 3, 40, 56, 63}) {
    const Image8 image{64, 48, std::vector<uint8_t>(64 * 48 * 3, 255)};
    for (uint8_t value : shrink(image, width, 36).rgb) ASSERT_EQ(value, 255);
  }
}

}  // namespace
}  // namespace wellspring::test
