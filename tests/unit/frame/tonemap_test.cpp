// SPDX-License-Identifier: Apache-2.0
#include "frame/tonemap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "unit/frame/tonemap_color.h"

namespace wellspring::test {
namespace {

Frame row_of(std::vector<vec3> colors) {
  return Frame{.width = int(colors.size()), .height = 1, .color = std::move(colors)};
}

vec3 shown(vec3 color, float exposure = 1) {
  Image8 image;
  tonemap(row_of({color}), {exposure}, image);
  return {image.rgb[0], image.rgb[1], image.rgb[2]};
}

double srgb(double x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055; }

TEST(Tonemap, BelowTheShoulderIsPlainSrgb) {
  std::vector<vec3> ramp;
  for (int i = 0; i <= 8000; i++) ramp.push_back(vec3(float(i) * 1e-4f));
  Image8 image;
  tonemap(row_of(ramp), {}, image);
  for (size_t i = 0; i < ramp.size(); i++) {
    double exact = srgb(ramp[i].x) * 255;
    ASSERT_NEAR(image.rgb[3 * i], exact, 0.5 + 0.05) << "radiance " << ramp[i].x;
  }
}

TEST(Tonemap, FastCurveAgreesWithTheExactOneOverTheWholeRange) {
  std::vector<vec3> colors;
  uint32_t state = 1;
  auto next = [&] { return float((state = state * 1664525u + 1013904223u) >> 8) * 0x1p-24f; };
  for (int i = 0; i < 200000; i++) {
    float scale = std::exp2(next() * 24 - 12);
    colors.push_back(vec3(next(), next(), next()) * scale);
  }
  Image8 image;
  Tonemap settings{0.7f};
  tonemap(row_of(colors), settings, image);
  for (size_t i = 0; i < colors.size(); i++) {
    vec3 exact = test::tonemap_color(colors[i], settings) * 255.0f;
    for (int c = 0; c < 3; c++) ASSERT_NEAR(image.rgb[3 * i + size_t(c)], exact[c], 1) << i;
  }
}

TEST(Tonemap, BrightColorsKeepTheirOrderAndNeverGrowDarker) {
  float last = 0;
  for (float x = 0; x < 100; x = x * 1.01f + 0.001f) {
    vec3 c = test::tonemap_color(vec3(x, x * 0.5f, x * 0.25f), {});
    ASSERT_GE(c.x, last);
    ASSERT_GE(c.x, c.y);
    ASSERT_GE(c.y, c.z);
    ASSERT_LE(c.x, 1.0f);
    last = c.x;
  }
}

TEST(Tonemap, HueOfABrightObjectStays) {
  // A gilded frame lit to twice the white point: channel order and ratio survive the shoulder.
  vec3 bright = test::tonemap_color(vec3(2.0f, 1.4f, 0.5f), {});
  EXPECT_GT(bright.x - bright.z, 0.15f);
  EXPECT_GT(bright.x - bright.y, 0.05f);
  EXPECT_GT(bright.y - bright.z, 0.1f);
}

TEST(Tonemap, ExposureMultipliesRadiance) {
  EXPECT_EQ(shown(vec3(0.1f, 0.2f, 0.05f), 2), shown(vec3(0.2f, 0.4f, 0.1f), 1));
  EXPECT_EQ(shown(vec3(0.5f), 0), vec3(0));
}

TEST(Tonemap, WhatIsNoRadianceIsBlackAndInfinityIsWhite) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(),
                  inf = std::numeric_limits<float>::infinity();
  EXPECT_EQ(shown(vec3(nan)), vec3(0));
  EXPECT_EQ(shown(vec3(-1, -inf, nan)), vec3(0));
  EXPECT_EQ(shown(vec3(inf)), vec3(255));
  EXPECT_EQ(shown(vec3(inf, 0, 0)), vec3(255));
  EXPECT_EQ(shown(vec3(3e38f), 1e30f), vec3(255));
  EXPECT_EQ(shown(vec3(1), nan), vec3(0));
  vec3 mixed = shown(vec3(0.5f, nan, -1));
  EXPECT_GT(mixed.x, 100);
  EXPECT_EQ(mixed.y, 0);
  EXPECT_EQ(mixed.z, 0);
}

TEST(Tonemap, EveryPixelOfAnOddSizeIsWritten) {
  Frame frame{.width = 131, .height = 37};
  for (int i = 0; i < frame.width * frame.height; i++)
    frame.color.push_back(vec3(float(i % 97) / 97));
  Image8 image;
  image.rgb.assign(7, 9);  // reused memory of another size
  tonemap(frame, {}, image);
  ASSERT_EQ(image.rgb.size(), frame.color.size() * 3);
  EXPECT_EQ(image.width, 131);
  EXPECT_EQ(image.height, 37);
  for (size_t i = 0; i < frame.color.size(); i++)
    ASSERT_NEAR(image.rgb[3 * i + 2], test::tonemap_color(frame.color[i], {}).z * 255, 1) << i;
  frame.color.pop_back();
  EXPECT_THROW(tonemap(frame, {}, image), std::invalid_argument);
}

// Codes and the peak's byte give light back: to codes of darkness as near as codes are, and of what
// is beyond white how bright it is, and of which colour as far as the codes show it.
TEST(Tonemap, LightComesBackFromCodesAndPeaks) {
  auto there_and_back = [](vec3 light, vec3& again) {
    vec3 codes = shown(light);
    uint8_t peak = uint8_t(eval_peak_codes(all_lanes(max_component(light)))[0]);
    auto linear = [](float code) {
      double x = code / 255.0;
      return float(x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4));
    };
    again = invert_tone_curve({linear(codes.x), linear(codes.y), linear(codes.z)}, peak);
    return codes;
  };
  for (float x = 0.01f; x < 120; x *= 1.01f) {
    vec3 light = vec3(1, 0.9f, 0.8f) * x, again;
    vec3 codes = there_and_back(light, again);
    EXPECT_NEAR(again.x, light.x, 0.02f * light.x + 0.0005f);
    EXPECT_NEAR(again.z, light.z, (x < 10 ? 0.04f : 0.25f) * light.z + 0.0005f) << x;
    vec3 recoded = shown(again);
    for (int c = 0; c < 3; c++) EXPECT_NEAR(recoded[c], codes[c], 1) << x;
  }
  vec3 again;
  for (float x : {1e5f, INFINITY, NAN, -1.0f, 0.0f}) {
    there_and_back(vec3(x), again);
    for (int c = 0; c < 3; c++)
      EXPECT_TRUE(x > 1 ? again[c] > 100 && again[c] < 130 : again[c] == 0)
          << x << ": " << again[c];
  }
}

}  // namespace
}  // namespace wellspring::test
