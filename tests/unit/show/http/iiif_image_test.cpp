// SPDX-License-Identifier: Apache-2.0
#include "show/http/iiif_image.h"

#include <gtest/gtest.h>

#include "store/picture/kept_levels.h"

namespace wellspring::test {
namespace {

// Makes a picture in memory whose levels have tiles of 256.
std::shared_ptr<const PicturePyramid> make_picture(int width, int height,
                                                   const std::function<int(int, int, int)>& code) {
  Piece whole{width, height, {}};
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++)
      for (int c = 0; c < 4; c++) whole.bytes.push_back(uint8_t(c < 3 ? code(x, y, c) : 255));
  return make_pyramid(std::move(whole));
}
int smooth(int x, int y, int c) { return c == 0 ? x / 8 : c == 1 ? y / 8 : 100; }
int rough(int x, int y, int c) { return (x * 37 + y * 91 + c * 50) % 256; }

Image8 make(const PicturePyramid& pyramid, const std::string& text) {
  const PyramidLevel& finest = pyramid.levels()[0];
  const IiifQuestion question = read_iiif_request(text, finest.width, finest.height);
  EXPECT_EQ(question.status, 200) << text << ": " << question.problem;
  return make_iiif_image(pyramid, question.request);
}
int code_at(const Image8& image, int x, int y, int c) {
  return image.rgb[(size_t(y) * size_t(image.width) + size_t(x)) * 3 + size_t(c)];
}

TEST(IiifImage, ARegionAtItsSizeIsItsTexels) {
  const auto picture = make_picture(700, 600, rough);
  const Image8 image = make(*picture, "130,240,300,299/max/0/default.jpg");
  ASSERT_EQ(image.width, 300);
  ASSERT_EQ(image.height, 299);
  for (int y = 0; y < image.height; y++)
    for (int x = 0; x < image.width; x++)
      for (int c = 0; c < 3; c++)
        ASSERT_EQ(code_at(image, x, y, c), rough(130 + x, 240 + y, c)) << x << ", " << y;
}

TEST(IiifImage, TilesOfALevelAreItsTexels) {
  const auto picture = make_picture(2001, 1500, rough);
  ASSERT_EQ(picture->levels().size(), 4u);
  const PyramidLevel& level = picture->levels()[1];
  ASSERT_EQ(iiif_scale(level, picture->levels()[0]), 2);
  const Image8 inner = make(*picture, "512,1024,512,476/256,238/0/default.jpg");
  const Image8 edge = make(*picture, "1536,0,465,512/233,256/0/default.jpg");
  const Fetched inner_tile = picture->fetch({1, 1, 1, 2}), edge_tile = picture->fetch({1, 1, 3, 0});
  for (const auto& [image, tile] : {std::pair(&inner, &inner_tile), {&edge, &edge_tile}}) {
    ASSERT_EQ(image->width, tile->piece->width);
    ASSERT_EQ(image->height, tile->piece->height);
    for (size_t i = 0; i < image->rgb.size(); i++)
      ASSERT_EQ(image->rgb[i], tile->piece->bytes[i / 3 * 4 + i % 3]) << i;
  }
}

TEST(IiifImage, AnySizeShowsTheSamePicture) {
  const auto picture = make_picture(2000, 1600, smooth);
  for (const char* size :
       {"2000,", "1999,", "1000,", "999,", "517,", "250,", "33,", "500,100", "^3000,"}) {
    const Image8 image = make(*picture, "full/" + std::string(size) + "/0/default.jpg");
    for (int y = 1; y + 1 < image.height; y += 7)
      for (int x = 1; x + 1 < image.width; x += 7) {
        const double across = (x + 0.5) * 2000 / image.width,
                     down = (y + 0.5) * 1600 / image.height;
        ASSERT_NEAR(code_at(image, x, y, 0), across / 8 - 0.5, 2) << size << ": " << x << ", " << y;
        ASSERT_NEAR(code_at(image, x, y, 1), down / 8 - 0.5, 2) << size << ": " << x << ", " << y;
        ASSERT_EQ(code_at(image, x, y, 2), 100) << size << ": " << x << ", " << y;
      }
  }
}

TEST(IiifImage, LightIsAveragedAndNotCodes) {
  const auto picture = make_picture(512, 512, [](int x, int y, int) { return (x + y) % 2 * 255; });
  const Image8 image = make(*picture, "full/64,/0/default.jpg");
  for (const uint8_t code : image.rgb) ASSERT_NEAR(code, 188, 1);
}

TEST(IiifImage, IsMirroredThenTurnedClockwise) {
  const auto picture = make_picture(40, 24, rough);
  const auto expect = [&](const char* rotation, int width, auto texel) {
    const Image8 image = make(*picture, "full/max/" + std::string(rotation) + "/default.png");
    ASSERT_EQ(image.width, width) << rotation;
    for (int y = 0; y < image.height; y++)
      for (int x = 0; x < image.width; x++) {
        const auto [column, row] = texel(x, y);
        ASSERT_EQ(code_at(image, x, y, 0), rough(column, row, 0)) << rotation;
      }
  };
  expect("90", 24, [](int x, int y) { return std::pair(y, 23 - x); });
  expect("180", 40, [](int x, int y) { return std::pair(39 - x, 23 - y); });
  expect("270", 24, [](int x, int y) { return std::pair(39 - y, x); });
  expect("!0", 40, [](int x, int y) { return std::pair(39 - x, y); });
  expect("!90", 24, [](int x, int y) { return std::pair(39 - y, 23 - x); });
}

TEST(IiifImage, GreysHaveTheLuminance) {
  const auto picture = make_picture(64, 64, [](int, int, int c) { return c == 1 ? 255 : 0; });
  EXPECT_NEAR(code_at(make(*picture, "full/max/0/gray.png"), 5, 5, 0), 220, 1);
  EXPECT_EQ(code_at(make(*picture, "full/max/0/bitonal.png"), 5, 5, 2), 255);
}

TEST(IiifImage, WhatIsTransparentIsWhite) {
  const auto picture = make_pyramid({20, 20, std::vector<uint8_t>(20 * 20 * 4)});
  for (const char* size : {"max", "7,", "^50,"})
    for (const uint8_t code : make(*picture, "full/" + std::string(size) + "/0/default.png").rgb)
      ASSERT_EQ(code, 255) << size;
}

TEST(IiifImage, WorkIsBounded) {
  // Levels lie far apart, and no tile is there.
  struct Sparse : PicturePyramid {
    mutable int64_t fetched = 0;
    Sparse() { levels_ = {{int64_t(1) << 24, int64_t(1) << 24}, {1024, 1024}}; }
    Fetched fetch(PieceKey) const override { return fetched++, Fetched{}; }
  } picture;
  make(picture, "full/4096,/0/default.jpg");
  EXPECT_EQ(picture.fetched, 16);
  EXPECT_EQ(iiif_scale(picture.levels()[1], picture.levels()[0]), 1 << 14);
  const IiifQuestion tile = read_iiif_request("0,0,4000,4000/max/0/default.jpg", 1 << 24, 1 << 24);
  EXPECT_NEAR(double(iiif_cost(picture, tile.request)), 32e6, 1e3);
}

}  // namespace
}  // namespace wellspring::test
