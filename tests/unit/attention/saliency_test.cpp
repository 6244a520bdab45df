// SPDX-License-Identifier: Apache-2.0
// Saliency: what differs from all others is found wherever it is, and what is even says nothing.
#include "attention/saliency.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "base/rng.h"
#include "unit/attention/bars.h"
#include "unit/attention/saliency_at.h"

namespace wellspring::test {
namespace {

Image8 noise(int width, int height, uint64_t seed) {
  Image8 picture{width, height, {}};
  for (int i = 0; i < 3 * width * height; i++)
    picture.rgb.push_back(uint8_t(mix64(seed * 1000003 + uint64_t(i))));
  return picture;
}

Image8 mirrored(const Image8& picture) {
  Image8 mirror = picture;
  for (int y = 0; y < picture.height; y++)
    for (int x = 0; x < picture.width; x++)
      for (int c = 0; c < 3; c++)
        mirror.rgb[size_t(3 * (y * picture.width + x) + c)] =
            picture.rgb[size_t(3 * (y * picture.width + picture.width - 1 - x) + c)];
  return mirror;
}

// The largest saliency further than three quarters of a cell from the target.
float largest_elsewhere(const SaliencyMap& saliency, const Bars& bars, ivec2 size) {
  float largest = 0;
  for (int y = 0; y < saliency.map.height; y++)
    for (int x = 0; x < saliency.map.width; x++) {
      vec2 place = (vec2(float(x), float(y)) - saliency.offset) * 16.0f;
      vec2 off = glm::abs(place - bar_middle(bars, bars.place, size)) / cell_size(bars, size);
      if (off.x > 0.75f || off.y > 0.75f) largest = std::max(largest, saliency.map.row(y)[x]);
    }
  return largest;
}

// The target is by far the most salient in every size of picture and in cells everywhere.
void expect_pop_out(Color8 ground, Color8 bar, Color8 target) {
  for (ivec2 size : {ivec2(256, 256), ivec2(512, 512), ivec2(640, 360), ivec2(333, 251)})
    for (ivec2 place :
         {ivec2(1, 1), ivec2(4, 2), ivec2(2, 3), ivec2(3, 4), ivec2(0, 2), ivec2(5, 5)}) {
      Bars bars{ground, bar, target, 6, place};
      SaliencyMap saliency = saliency_of(make_bars(bars, size.x, size.y));
      vec2 off = glm::abs(most_salient_place(saliency) - bar_middle(bars, place, size)) /
                 cell_size(bars, size);
      EXPECT_LT(off.x, 0.5f) << size.x << "x" << size.y << " at " << place.x << "," << place.y;
      EXPECT_LT(off.y, 0.5f) << size.x << "x" << size.y << " at " << place.x << "," << place.y;
      EXPECT_LT(largest_elsewhere(saliency, bars, size), 0.6f) << place.x << "," << place.y;
    }
}

constexpr Color8 grey{110, 110, 110}, black{0, 0, 0}, red{200, 40, 40}, green{40, 200, 40},
    blue{40, 40, 200}, yellow{200, 200, 40};

TEST(Saliency, ARedBarPopsOutAmongGreenOnes) { expect_pop_out(grey, green, red); }
TEST(Saliency, AGreenBarPopsOutAmongRedOnes) { expect_pop_out(grey, red, green); }
TEST(Saliency, ABlueBarPopsOutAmongYellowOnes) { expect_pop_out(grey, yellow, blue); }
TEST(Saliency, AYellowBarPopsOutAmongBlueOnes) { expect_pop_out(grey, blue, yellow); }
TEST(Saliency, ColoursPopOutOnBlack) { expect_pop_out(black, green, red); }
TEST(Saliency, ABrightBarPopsOutAmongDimOnes) {
  expect_pop_out(black, {90, 90, 90}, {230, 230, 230});
}
// All bars differ from the ground alike.
TEST(Saliency, ADarkBarPopsOutAmongBrightOnes) {
  expect_pop_out({110, 110, 110}, {200, 200, 200}, {20, 20, 20});
}

TEST(Saliency, AnEvenPictureHasNone) {
  for (Color8 color : {Color8{0, 0, 0}, {255, 255, 255}, {1, 1, 1}, {200, 30, 30}, {17, 94, 201}})
    for (ivec2 size : {ivec2(512, 512), ivec2(333, 251), ivec2(16, 9), ivec2(1, 1)}) {
      SaliencyMap saliency = saliency_of(even_picture(size.x, size.y, color));
      for (float value : saliency.map.value) ASSERT_EQ(value, 0);
    }
}

TEST(Saliency, PicturesOfAnySizeHaveFiniteMaps) {
  for (ivec2 size : {ivec2(1, 1), ivec2(7, 3), ivec2(3, 7), ivec2(2, 2), ivec2(1, 200),
                     ivec2(200, 1), ivec2(9, 9), ivec2(31, 17), ivec2(257, 129)}) {
    SaliencyMap saliency = saliency_of(noise(size.x, size.y, 3));
    EXPECT_EQ(saliency.map.width, (size.x + 15) / 16);
    EXPECT_EQ(saliency.map.height, (size.y + 15) / 16);
    ASSERT_EQ(saliency.map.value.size(), size_t(saliency.map.width * saliency.map.height));
    for (float value : saliency.map.value) {
      ASSERT_GE(value, 0);
      ASSERT_LE(value, 1);
    }
  }
  EXPECT_TRUE(saliency_of(Image8{}).map.value.empty());
  EXPECT_EQ(test::eval_saliency_at(SaliencyMap{}, vec2(3)), 0);
}

TEST(Saliency, TheMostSalientPlaceIsOne) {
  Bars bars{grey, green, red, 6, {2, 3}};
  const SaliencyMap saliency = saliency_of(make_bars(bars, 512, 512));
  EXPECT_FLOAT_EQ(*std::max_element(saliency.map.value.begin(), saliency.map.value.end()), 1);
  EXPECT_FLOAT_EQ(test::eval_saliency_at(saliency, most_salient_place(saliency)), 1);
}

TEST(Saliency, AMirroredPictureHasTheMirroredMap) {
  for (ivec2 size : {ivec2(256, 192), ivec2(333, 251), ivec2(75, 50)}) {
    Image8 picture = noise(size.x, size.y, 9);
    paint(picture, ivec2(size.x / 8, size.y / 3), ivec2(size.x / 4, size.y / 2), red);
    Plane map = saliency_of(picture).map, mirror = saliency_of(mirrored(picture)).map;
    for (int y = 0; y < map.height; y++)
      for (int x = 0; x < map.width; x++)
        ASSERT_NEAR(map.row(y)[x], mirror.row(y)[map.width - 1 - x], 1e-3f) << size.x;
  }
}

TEST(Saliency, PlacesOfPictureAndMapAgree) {
  for (ivec2 size : {ivec2(512, 512), ivec2(501, 333), ivec2(77, 49)}) {
    SaliencyMap saliency = saliency_of(noise(size.x, size.y, 5));
    // The picture's middle is the map's, since both are symmetrical.
    vec2 middle = saliency.offset + 0.5f * vec2(size - 1) / 16.0f;
    EXPECT_NEAR(middle.x, 0.5f * float(saliency.map.width - 1), 1e-4f);
    EXPECT_NEAR(middle.y, 0.5f * float(saliency.map.height - 1), 1e-4f);
  }
}

TEST(Saliency, TheSameForAnyNumberOfThreads) {
  Image8 picture = noise(517, 300, 4);
  Plane all = saliency_of(picture).map;
  oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(saliency_of(picture).map.value, all.value);
}

TEST(Saliency, PicturesOfOneSizeAllocateOnce) {
  SaliencyWork work;
  SaliencyMap saliency;
  eval_saliency(noise(300, 200, 1), work, saliency);
  size_t bytes = memory_bytes(work);
  const float* map = saliency.map.value.data();
  std::vector<float> first = saliency.map.value;
  eval_saliency(noise(300, 200, 2), work, saliency);
  eval_saliency(noise(300, 200, 1), work, saliency);
  EXPECT_EQ(memory_bytes(work), bytes);
  EXPECT_EQ(saliency.map.value.data(), map);
  EXPECT_EQ(saliency.map.value, first);  // nothing of an earlier picture is left
}

struct Opponents {
  float intensity, red_green, blue_yellow;
};

Opponents eval_opponents(float r, float g, float b, float dark) {
  float out[channel_count];
  eval_channels(
      r, g, b, dark, [](float x, float y) { return std::min(x, y); },
      [](float x) { return std::max(x, 0.0f); }, [](bool is, float x) { return is ? x : 0.0f; },
      out);
  return {out[0], out[1], out[2]};
}

// These values are computed by hand, after Itti, Koch, Niebur 1998.
TEST(Saliency, OpponentColoursByHand) {
  Opponents pure_red = eval_opponents(255, 0, 0, 0);
  EXPECT_FLOAT_EQ(pure_red.intensity, 1 / 3.0f);
  EXPECT_FLOAT_EQ(pure_red.red_green, 1);
  EXPECT_FLOAT_EQ(pure_red.blue_yellow, 0);
  EXPECT_FLOAT_EQ(eval_opponents(0, 100, 0, 0).red_green, -1);
  EXPECT_FLOAT_EQ(eval_opponents(0, 0, 50, 0).blue_yellow, 1);
  EXPECT_FLOAT_EQ(eval_opponents(200, 200, 0, 0).blue_yellow, -0.5f);
  EXPECT_FLOAT_EQ(eval_opponents(200, 200, 0, 0).red_green, 0);
  // r = 120, g = 60, b = 20: R = 80, G = 0 (60 - 70), B = 0, Y = 40.
  Opponents brown = eval_opponents(120, 60, 20, 0);
  EXPECT_FLOAT_EQ(brown.red_green, 0.4f);
  EXPECT_FLOAT_EQ(brown.blue_yellow, -0.2f);
  EXPECT_EQ(eval_opponents(20, 0, 0, 20).red_green, 0);  // too dark for hue
  EXPECT_EQ(eval_opponents(0, 0, 0, 0).red_green, 0);
  EXPECT_EQ(eval_opponents(90, 90, 90, 0).blue_yellow, 0);
}

TEST(Saliency, OnePeakIsPromotedOverManyEqualOnes) {
  Plane one, many;
  fit_plane(32, 32, one), fit_plane(32, 32, many);
  for (int y = 0; y < 32; y++)
    for (int x = 0; x < 32; x++) {
      one.row(y)[x] = x == 9 && y == 20 ? 3.0f : 0.0f;
      many.row(y)[x] = x % 4 == 1 && y % 4 == 1 ? 3.0f : 0.0f;
    }
  promote_peaks(one), promote_peaks(many);
  EXPECT_FLOAT_EQ(one.row(20)[9], 1);
  EXPECT_EQ(*std::max_element(many.value.begin(), many.value.end()), 0);
}

// Peaks 1, 0.6 and 0.2 over 0: (1 - 0.4)^2 = 0.36. The flat top of 0.6 counts once, 0.05 does not.
TEST(Saliency, PromotionByHand) {
  Plane map{9, 3, std::vector<float>(27, 2.0f)};
  map.row(1)[0] = 2 + 5;
  map.row(1)[3] = map.row(1)[4] = map.row(2)[3] = 2 + 3;
  map.row(0)[6] = 2 + 1;
  map.row(1)[8] = 2 + 0.25f;
  promote_peaks(map);
  EXPECT_NEAR(map.row(1)[0], 0.36f, 1e-6f);
  EXPECT_NEAR(map.row(2)[3], 0.36f * 0.6f, 1e-6f);
  EXPECT_EQ(map.row(0)[0], 0);
}

TEST(Saliency, ContrastThatIsNoiseIsNotPromoted) {
  Plane faint{5, 1, {0, 0, 0.001f, 0, 0}};
  promote_peaks(faint);
  EXPECT_NEAR(faint.value[2], 0.001f, 1e-6f);  // 0.1 of the least range, times 0.1^2
}

}  // namespace
}  // namespace wellspring::test
