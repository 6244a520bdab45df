// SPDX-License-Identifier: Apache-2.0
// FLIP: bounds, symmetry, what it must and must not see, and the reference tool's own map of a pair
// of photographs, pixel by pixel.
#include "judge/flip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <stdexcept>
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_image.h>

#include "base/rng.h"

namespace wellspring::test {
namespace {

Image8 flat(int width, int height, int r, int g, int b) {
  Image8 image{width, height, {}};
  for (int i = 0; i < width * height; i++)
    for (int c : {r, g, b}) image.rgb.push_back(uint8_t(c));
  return image;
}
Image8 noise(int width, int height, uint64_t seed) {
  Image8 image{width, height, {}};
  for (int i = 0; i < 3 * width * height; i++)
    image.rgb.push_back(uint8_t(mix64(seed * 1000003 + uint64_t(i))));
  return image;
}
// Vertical stripes, `shift` pixels to the right.
Image8 stripes(int width, int height, int period, int shift) {
  Image8 image = flat(width, height, 0, 0, 0);
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++)
      for (int c = 0; c < 3; c++)
        image.rgb[size_t(3 * (y * width + x) + c)] =
            (x - shift + 4 * period) / period % 2 ? 200 : 40;
  return image;
}
Image8 load_png(const std::filesystem::path& path) {
  Image8 image;
  int channels = 0;
  uint8_t* texels = stbi_load(path.c_str(), &image.width, &image.height, &channels, 3);
  if (texels) image.rgb.assign(texels, texels + 3 * size_t(image.width) * size_t(image.height));
  stbi_image_free(texels);
  return image;
}

TEST(Flip, APictureDoesNotDifferFromItself) {
  Image8 picture = noise(61, 43, 1);
  FlipMap map = eval_flip(picture, picture);
  EXPECT_EQ(map.mean, 0);
  EXPECT_EQ(*std::max_element(map.error.begin(), map.error.end()), 0);
  EXPECT_EQ(map.error.size(), size_t(61 * 43));
}

TEST(Flip, SymmetricAndBounded) {
  Image8 a = noise(64, 40, 1), b = stripes(64, 40, 5, 0);
  FlipMap there = eval_flip(a, b), back = eval_flip(b, a);
  EXPECT_EQ(there.error, back.error);
  double sum = 0;
  for (float error : there.error) {
    EXPECT_GT(error, 0);
    EXPECT_LE(error, 1);
    sum += double(error);
  }
  EXPECT_NEAR(there.mean, sum / double(there.error.size()), 1e-12);
}

// Without edges only the colour counts, and the filters leave a flat picture as it is, so the
// paper's formulas can be followed by hand.
TEST(Flip, FlatPicturesByHand) {
  // Green against blue is the largest colour difference there is: error 1 by definition.
  EXPECT_NEAR(eval_flip(flat(9, 9, 0, 255, 0), flat(9, 9, 0, 0, 255)).mean, 1, 1e-5);
  // Black against white: lightness 100 apart, L^0.7 = 25.12. The largest difference, green to
  // blue, is (|87.735 - 32.297| + |(-75.62, 72.98) - (25.58, -34.84)|)^0.7 = 203.32^0.7 = 41.28
  // (Lab after Hunt's adjustment), the knee 0.4 of it 16.51 takes 0.95.
  double expected = 0.95 + (std::pow(100, 0.7) - 0.4 * 41.28) / (0.6 * 41.28) * 0.05;
  EXPECT_NEAR(eval_flip(flat(9, 9, 0, 0, 0), flat(9, 9, 255, 255, 255)).mean, expected, 1e-3);
  // sRGB 118 against 119: lightness 49.637 and 50.034.
  double grey = std::pow(50.034 - 49.637, 0.7) * 0.95 / (0.4 * 41.28);
  EXPECT_NEAR(eval_flip(flat(9, 9, 118, 118, 118), flat(9, 9, 119, 119, 119)).mean, grey, 2e-3);
}

TEST(Flip, ShiftedEdgesAreSeenWhereTheyAre) {
  Image8 reference = stripes(96, 48, 16, 0);
  double one = eval_flip(stripes(96, 48, 16, 1), reference).mean;
  double four = eval_flip(stripes(96, 48, 16, 4), reference).mean;
  EXPECT_GT(one, 0.02);
  EXPECT_GT(four, one);
  // One edge in an even surface: nothing is seen farther from it than both filters reach.
  Image8 step = flat(96, 8, 40, 40, 40), moved = step;
  for (int y = 0; y < 8; y++)
    for (int x = 47; x < 96; x++)
      for (int c = 0; c < 3; c++) {
        moved.rgb[size_t(3 * (y * 96 + x) + c)] = 200;
        if (x > 47) step.rgb[size_t(3 * (y * 96 + x) + c)] = 200;
      }
  FlipMap map = eval_flip(moved, step);
  EXPECT_GT(map.error[4 * 96 + 47], 0.3);
  for (int x : {0, 20, 36, 58, 95}) EXPECT_LT(map.error[size_t(4 * 96 + x)], 1e-3) << x;
}

TEST(Flip, DetailFinerThanTheEyeIsForgiven) {
  Image8 fine = stripes(128, 64, 1, 0), flipped = stripes(128, 64, 1, 1);
  double near = eval_flip(fine, flipped, {20}).mean, far = eval_flip(fine, flipped, {120}).mean;
  EXPECT_LT(far, 0.5 * near);
}

TEST(Flip, FramesAreComparedAsTheyAreShown) {
  Frame a, b;
  a.width = b.width = a.height = b.height = 16;
  a.color.assign(256, vec3(0.5f));
  b.color.assign(256, vec3(0.25f));
  Image8 shown_a, shown_b;
  tonemap(a, {1.5f}, shown_a);
  tonemap(b, {1.5f}, shown_b);
  EXPECT_EQ(flip(a, b, {1.5f}), eval_flip(shown_a, shown_b).mean);
  EXPECT_GT(flip(a, b), 0);
  // Beyond what the screen can show, and what is no number: no more than white and black.
  b.color.assign(256, vec3(1e30f));
  a.color.assign(256, vec3(std::numeric_limits<float>::infinity()));
  EXPECT_EQ(flip(a, b), 0);
  a.color.assign(256, vec3(NAN));
  b.color.assign(256, vec3(0));
  EXPECT_EQ(flip(a, b), 0);
}

TEST(Flip, WrongSizesAreErrors) {
  Image8 small = flat(3, 2, 0, 0, 0), other = flat(2, 3, 0, 0, 0), broken = small;
  broken.rgb.pop_back();
  EXPECT_THROW(eval_flip(small, other), std::invalid_argument);
  EXPECT_THROW(eval_flip(Image8{}, Image8{}), std::invalid_argument);
  EXPECT_THROW(eval_flip(small, broken), std::invalid_argument);
  EXPECT_THROW(eval_flip(small, small, {0}), std::invalid_argument);
  EXPECT_THROW(eval_flip(small, small, {NAN}), std::invalid_argument);
  EXPECT_EQ(eval_flip(flat(1, 1, 9, 9, 9), flat(1, 1, 9, 9, 9)).mean, 0);
}

// The reference tool wrote its error of each pixel as one of 256 colours (magma), the darkest for
// 0: the colour of index k stands for errors that round to k / 255. So each colour must belong to
// one k, each k to one colour, and colours must brighten with k.
TEST(Flip, AgreesWithTheReferenceToolPixelByPixel) {
  std::filesystem::path folder = std::filesystem::path(WELLSPRING_DATA) / "7_flip/nv_flip_rs/etc";
  if (!std::filesystem::exists(folder / "tree-comparison-cli.png"))
    GTEST_SKIP() << "the reference tool's pictures are not at " << folder;
  Image8 test = load_png(folder / "tree-test.png"), reference = load_png(folder / "tree-ref.png"),
         colors = load_png(folder / "tree-comparison-cli.png");
  ASSERT_EQ(colors.rgb.size(), test.rgb.size());
  FlipMap map = eval_flip(test, reference);
  std::map<uvec3, std::vector<float>, bool (*)(const uvec3&, const uvec3&)> errors(
      [](const uvec3& a, const uvec3& b) {
        return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
      });
  for (size_t i = 0; i < map.error.size(); i++)
    errors[{colors.rgb[3 * i], colors.rgb[3 * i + 1], colors.rgb[3 * i + 2]}].push_back(
        255 * map.error[i]);
  ASSERT_GT(errors.size(), 240u);
  std::map<int, float> brightness;  // by index
  double mean = 0;
  for (auto& [color, of_color] : errors) {
    std::sort(of_color.begin(), of_color.end());
    int k = int(std::lround(of_color[of_color.size() / 2]));
    EXPECT_GT(of_color.front(), float(k) - 0.51f) << k;
    EXPECT_LT(of_color.back(), float(k) + 0.51f) << k;
    EXPECT_FALSE(brightness.contains(k)) << k;
    brightness[k] = 0.2126f * float(color.x) + 0.7152f * float(color.y) + 0.0722f * float(color.z);
    mean += k * double(of_color.size());
  }
  EXPECT_TRUE(brightness.contains(0));
  EXPECT_LT(brightness.rbegin()->first, 256);
  float before = 0;
  for (const auto& [k, value] : brightness) {
    EXPECT_GT(value, before - 1.5f) << k;  // colours are rounded
    before = value;
  }
  // Each index is off by at most half a step; together they hardly are.
  EXPECT_NEAR(map.mean, mean / 255 / double(map.error.size()), 2e-4);
}

}  // namespace
}  // namespace wellspring::test
