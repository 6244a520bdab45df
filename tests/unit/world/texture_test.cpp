// SPDX-License-Identifier: Apache-2.0
#include "world/texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace wellspring::test {
namespace {

// 4x1 picture whose red counts 0, 0.25, 0.5, 0.75.
Image ramp() {
  Image image{.width = 4, .height = 1};
  for (int i = 0; i < 4; i++) image.texels.push_back(vec4(0.25f * float(i), 0, 0, 1));
  return image;
}

float red(Wrap wrap, bool nearest, float u) {
  Texture texture{.image = 0, .wrap_u = wrap, .nearest = nearest};
  return eval_texture(ramp(), texture, vec2(u, 0.5f)).x;
}

TEST(Texture, TexelCentresAreExact) {
  for (Wrap wrap : {Wrap::repeat, Wrap::mirror, Wrap::clamp})
    for (int i = 0; i < 4; i++)
      EXPECT_NEAR(red(wrap, false, (float(i) + 0.5f) / 4), 0.25f * i, 1e-6f);
}

TEST(Texture, BilinearBetweenCentres) {
  EXPECT_NEAR(red(Wrap::clamp, false, 0.25f), 0.125f, 1e-6f);
  EXPECT_NEAR(red(Wrap::clamp, false, 0.4375f), 0.3125f, 1e-6f);
}

TEST(Texture, RepeatBlendsAcrossTheSeam) {
  EXPECT_NEAR(red(Wrap::repeat, false, 0.0f), 0.375f, 1e-6f);  // mean of the last and the first
  EXPECT_NEAR(red(Wrap::repeat, false, 1.0f), 0.375f, 1e-6f);
  EXPECT_NEAR(red(Wrap::repeat, false, -0.125f), 0.75f, 1e-6f);
  EXPECT_NEAR(red(Wrap::repeat, false, 7.375f), 0.25f, 1e-5f);
}

TEST(Texture, MirrorTurnsBack) {
  EXPECT_NEAR(red(Wrap::mirror, false, 0.0f), 0.0f, 1e-6f);
  EXPECT_NEAR(red(Wrap::mirror, false, 1.125f), 0.75f, 1e-6f);
  EXPECT_NEAR(red(Wrap::mirror, false, 1.875f), 0.0f, 1e-6f);
  EXPECT_NEAR(red(Wrap::mirror, false, -0.375f), 0.25f, 1e-6f);
}

TEST(Texture, ClampHoldsTheEdge) {
  EXPECT_NEAR(red(Wrap::clamp, false, -3.0f), 0.0f, 1e-6f);
  EXPECT_NEAR(red(Wrap::clamp, false, 9.0f), 0.75f, 1e-6f);
}

TEST(Texture, NearestTakesOneTexel) {
  EXPECT_EQ(red(Wrap::repeat, true, 0.249f), 0.0f);
  EXPECT_EQ(red(Wrap::repeat, true, 0.251f), 0.25f);
  EXPECT_EQ(red(Wrap::clamp, true, 1.0f), 0.75f);
}

TEST(Texture, SrgbIsDecodedBeforeFiltering) {
  Image image{.width = 2, .height = 1, .srgb = true, .texels8 = {0, 0, 0, 0, 255, 255, 255, 255}};
  Texture texture{.wrap_u = Wrap::clamp};
  vec4 middle = eval_texture(image, texture, vec2(0.5f, 0.5f));
  EXPECT_NEAR(middle.x, 0.5f, 1e-6f);
  EXPECT_NEAR(middle.w, 0.5f, 1e-6f);
  image.texels8 = {188, 188, 188, 188, 188, 188, 188, 188};
  vec4 grey = eval_texture(image, texture, vec2(0.3f, 0.5f));
  EXPECT_NEAR(grey.x, 0.5029f, 1e-3f);          // IEC 61966-2-1
  EXPECT_NEAR(grey.w, 188.0f / 255.0f, 1e-6f);  // alpha is never encoded
  image.srgb = false;
  EXPECT_NEAR(eval_texture(image, texture, vec2(0.3f, 0.5f)).x, 188.0f / 255.0f, 1e-6f);
}

TEST(Texture, TopRowFirst) {
  Image image{.width = 1, .height = 2, .texels = {vec4(1), vec4(0)}};
  Texture texture{.nearest = true};
  EXPECT_EQ(eval_texture(image, texture, vec2(0.5f, 0.25f)).x, 1.0f);
  EXPECT_EQ(eval_texture(image, texture, vec2(0.5f, 0.75f)).x, 0.0f);
}

TEST(Texture, AnyCoordinateIsSafe) {
  float infinity = std::numeric_limits<float>::infinity();
  for (float u : {1e30f, -1e30f, 3.4e38f, -0.0f, 1e-40f, infinity, -infinity, std::nanf("")})
    for (Wrap wrap : {Wrap::repeat, Wrap::mirror, Wrap::clamp})
      for (bool nearest : {false, true}) {
        float value = red(wrap, nearest, u);
        EXPECT_GE(value, 0.0f);
        EXPECT_LE(value, 0.75f);
      }
  EXPECT_EQ(red(Wrap::repeat, true, std::nanf("")), 0.0f);  // texel 0
}

TEST(Texture, BadTexelsReadAsZero) {
  Image image{.width = 1,
              .height = 1,
              .texels = {vec4(std::nanf(""), std::numeric_limits<float>::infinity(), 2, 1)}};
  vec4 value = eval_texture(image, Texture(), vec2(0.5f));
  EXPECT_EQ(value, vec4(0, 0, 2, 1));
}

TEST(Texture, NoTexelsMeansOne) {
  EXPECT_EQ(eval_texture(Image(), Texture(), vec2(0.5f)), vec4(1));
}

}  // namespace
}  // namespace wellspring::test
