// SPDX-License-Identifier: Apache-2.0
// Gaussian pyramids: symmetrical, of mean kept, and what is expanded lies where it was.
#include "attention/saliency.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/rng.h"

namespace wellspring::test {
namespace {

Plane noise(int width, int height) {
  Plane plane{width, height, {}};
  for (int i = 0; i < width * height; i++)
    plane.value.push_back(float(mix64(uint64_t(i)) % 1000) / 1000);
  return plane;
}

Plane reduced(const Plane& fine) {
  Plane narrow, coarse;
  reduce(fine, narrow, coarse);
  return coarse;
}

TEST(Pyramid, FiltersByHand) {
  EXPECT_EQ(reduced({8, 1, {0, 0, 0, 32, 0, 0, 0, 0}}).value, (std::vector<float>{1, 10, 5, 0}));
  EXPECT_EQ(reduced({1, 7, {0, 0, 0, 16, 0, 0, 0}}).value, (std::vector<float>{0, 4, 4, 0}));
  EXPECT_EQ(reduced({1, 1, {3}}).value, std::vector<float>{3});
  EXPECT_EQ(reduced({2, 1, {0, 32}}).value, std::vector<float>{16});  // borders go on
}

TEST(Pyramid, EvenPlanesStayEven) {
  for (int width : {1, 2, 3, 5, 8, 259, 512, 777}) {
    Plane plane{width, 6, std::vector<float>(size_t(width) * 6, 0.7f)};
    for (float value : reduced(plane).value) ASSERT_FLOAT_EQ(value, 0.7f) << width;
  }
}

// Longer rows are filtered in pieces: their seams must not show.
TEST(Pyramid, AMirroredPlaneHasTheMirroredPyramid) {
  for (int width : {7, 8, 255, 256, 257, 258, 515, 516}) {
    Plane plane = noise(width, 5), mirror = plane;
    for (int y = 0; y < 5; y++) std::reverse(mirror.row(y), mirror.row(y) + width);
    Plane coarse = reduced(plane), other = reduced(mirror);
    ASSERT_EQ(coarse.width, (width + 1) / 2);
    for (int y = 0; y < coarse.height; y++)
      for (int x = 0; x < coarse.width; x++)
        ASSERT_NEAR(coarse.row(y)[x], other.row(y)[coarse.width - 1 - x], 1e-6f) << width;
  }
}

// A slope is reduced and expanded to itself, away from the borders where it ends.
TEST(Pyramid, WhatIsExpandedLiesWhereItWas) {
  for (ivec2 size : {ivec2(40, 30), ivec2(41, 31), ivec2(40, 31)}) {
    Plane plane, narrow, fine;
    fit_plane(size.x, size.y, plane);
    for (int y = 0; y < size.y; y++)
      for (int x = 0; x < size.x; x++) plane.row(y)[x] = float(2 * x + 3 * y);
    expand(reduced(plane), size.x, size.y, narrow, fine);
    for (int y = 5; y < size.y - 5; y++)
      for (int x = 5; x < size.x - 5; x++)
        ASSERT_NEAR(fine.row(y)[x], plane.row(y)[x], 1e-4f) << size.x << "x" << size.y;
  }
}

TEST(Pyramid, CoarserPlacesAreThoseOfItsPixels) {
  for (int size : {40, 41}) {
    Plane slope;
    fit_plane(size, 1, slope);
    for (int x = 0; x < size; x++) slope.value[size_t(x)] = float(x);
    Plane coarse = reduced(slope);
    for (int i = 3; i < coarse.width - 3; i++)
      EXPECT_NEAR(coarser_place(coarse.value[size_t(i)], size), float(i), 1e-5f) << size;
  }
}

}  // namespace
}  // namespace wellspring::test
