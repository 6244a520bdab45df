// SPDX-License-Identifier: Apache-2.0
#include "frame/tiles.h"
#include "image/image.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace wellspring::test {
namespace {

Image8 grey(int width, int height, uint8_t value) {
  return {width, height, std::vector<uint8_t>(size_t(width) * size_t(height) * 3, value)};
}

TEST(Tiles, CoverTheWholePicture) {
  const TileGrid grid{100, 70};
  EXPECT_EQ(grid.size(), 12u);
  EXPECT_EQ(grid.part(0), (ImagePart{0, 0, 32, 32}));
  EXPECT_EQ(grid.part(11), (ImagePart{96, 64, 4, 6}));
}

TEST(Tiles, DifferencesAreFoundWhereTheyAre) {
  const Image8 a = grey(100, 70, 90);
  Image8 b = a;
  b.rgb[(65 * 100 + 99) * 3 + 2] = 93;
  const TileGrid grid{100, 70};
  for (size_t i = 0; i < grid.size(); i++) {
    EXPECT_EQ(differs(a, b, grid.part(i), 0), i == 11);
    EXPECT_EQ(differs(a, b, grid.part(i), 2), i == 11);
    EXPECT_FALSE(differs(a, b, grid.part(i), 3));
  }
  copy_part(b, grid.part(11), b);
  Image8 c = a;
  copy_part(b, grid.part(11), c);
  EXPECT_EQ(c.rgb, b.rgb);
}

TEST(Tiles, FewRectanglesCoverAllThatIsWanted) {
  const TileGrid grid{1280, 720};
  uint32_t state = 1;
  for (int turn = 0; turn < 200; turn++) {
    std::vector<char> wanted(grid.size());
    for (char& one : wanted)
      one = ((state = state * 1664525 + 1013904223) >> 24) % 256 < uint32_t(turn);
    const std::vector<ImagePart> parts = cover(grid, wanted, 8);
    EXPECT_LE(parts.size(), 8u);
    std::vector<int> covered(grid.size());
    size_t exact = 0;
    for (const ImagePart& part : cover(grid, wanted))
      for (size_t tile : tiles_in(grid, part)) exact += wanted[tile] ? 1 : grid.size();
    EXPECT_EQ(exact, size_t(std::ranges::count(wanted, 1)));
    for (const ImagePart& part : parts)
      for (size_t tile : tiles_in(grid, part)) covered[tile]++;
    for (size_t i = 0; i < grid.size(); i++) {
      ASSERT_LE(covered[i], 1);
      ASSERT_TRUE(covered[i] || !wanted[i]);
    }
  }
}

TEST(Tiles, WhatIsFarApartStaysApart) {
  const TileGrid grid{1280, 704};
  std::vector<char> wanted(grid.size());
  EXPECT_TRUE(cover(grid, wanted, 8).empty());
  wanted[0] = wanted[1] = wanted[40] = wanted[grid.size() - 1] = 1;
  EXPECT_EQ(cover(grid, wanted, 8), (std::vector<ImagePart>{{1248, 672, 32, 32}, {0, 0, 64, 64}}));
  EXPECT_EQ(cover(grid, wanted, 1), (std::vector<ImagePart>{{0, 0, 1280, 704}}));
}

TEST(Tiles, APartIsEncodedAsItIsInThePicture) {
  Image8 image = grey(96, 64, 20);
  copy_part(grey(96, 64, 220), {32, 32, 40, 20}, image);
  std::vector<uint8_t> bytes;
  encode_jpeg(image, {32, 32, 40, 20}, 95, true, bytes);
  const Image8 part = decode_jpeg(bytes, "part");
  ASSERT_EQ(part.width, 40);
  ASSERT_EQ(part.height, 20);
  for (uint8_t value : part.rgb) EXPECT_NEAR(value, 220, 2);
  EXPECT_THROW(encode_jpeg(image, {64, 0, 33, 8}, 95, true, bytes), std::invalid_argument);
  EXPECT_THROW(encode_jpeg(image, {-1, 0, 8, 8}, 95, true, bytes), std::invalid_argument);
}

}  // namespace
}  // namespace wellspring::test
