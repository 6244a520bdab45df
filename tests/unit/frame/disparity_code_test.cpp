// SPDX-License-Identifier: Apache-2.0
#include "frame/disparity_code.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "unit/wire/golden.h"

namespace wellspring::test {
namespace {

constexpr int width = 160, height = 90;
constexpr float unit = 1 / 3000.0f;

// Calls `of` with the place of every pixel.
template <class Of>
std::vector<float> picture(const Of& of, int across = width, int down = height) {
  std::vector<float> disparity;
  for (int y = 0; y < down; y++)
    for (int x = 0; x < across; x++) disparity.push_back(of(x, y));
  return disparity;
}

// A floor, a wall, and a pillar before them whose border is slanted.
float room(int x, int y) {
  if (x + y / 3 > 90 && x + y / 3 < 110) return 0.8f;
  return y > 50 ? 0.2f + 0.011f * float(y - 50) : 0.2f + 0.0007f * float(x);
}

std::vector<uint8_t> encoded(const std::vector<float>& disparity, int across = width,
                             int down = height) {
  std::vector<uint8_t> bytes;
  encode_disparity(disparity, across, down, unit, bytes);
  return bytes;
}

TEST(DisparityCode, IsOffByHalfAStepAtMost) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> noise(0, 20);
  const std::vector<float> pictures[] = {
      picture(room), picture([&](int, int) { return noise(random); }),
      picture([](int x, int y) { return (x / 3 + y / 2) % 2 ? 21.0f : 0.0f; }),
      picture([](int, int) { return 0.0f; })};
  for (const std::vector<float>& wanted : pictures) {
    std::vector<float> found;
    ASSERT_TRUE(decode_disparity(encoded(wanted), width, height, unit, found));
    ASSERT_EQ(found.size(), wanted.size());
    for (size_t i = 0; i < wanted.size(); i++)
      ASSERT_LE(std::abs(found[i] - wanted[i]), worst_units * unit * 1.001f + 1e-5f) << i;
  }
}

// A value that is no distance is as far away as can be, and one that is too near is as near as the
// code can say.
TEST(DisparityCode, HoldsWhateverDepthsThereAre) {
  const float odd[] = {std::numeric_limits<float>::infinity(), NAN, -1, 1e9f, 1e-30f, 0};
  const std::vector<float> wanted =
      picture([&](int x, int y) { return odd[size_t(x + y) % std::size(odd)]; });
  std::vector<float> found;
  ASSERT_TRUE(decode_disparity(encoded(wanted), width, height, unit, found));
  for (size_t i = 0; i < wanted.size(); i++) {
    const bool near = wanted[i] > 1;
    ASSERT_NEAR(found[i], near ? float(most_disparity) * unit : 0, worst_units * unit) << wanted[i];
  }
}

TEST(DisparityCode, PlanesAndBordersTakeFewBytes) {
  EXPECT_LT(encoded(picture(room)).size(), width * height / 20);
  EXPECT_LT(encoded(picture([](int, int) { return 0.0f; })).size(), 100u);
}

TEST(DisparityCode, SizesAreAnyAndAppended) {
  for (auto [across, down] : {std::pair(1, 1), {1, 50}, {50, 1}, {7, 3}}) {
    const std::vector<float> wanted = picture(room, across, down);
    std::vector<uint8_t> bytes{1, 2, 3};
    encode_disparity(wanted, across, down, unit, bytes);
    ASSERT_EQ(bytes[2], 3);
    std::vector<float> found;
    ASSERT_TRUE(decode_disparity(std::span(bytes).subspan(3), across, down, unit, found));
    for (size_t i = 0; i < wanted.size(); i++)
      ASSERT_NEAR(found[i], wanted[i], worst_units * unit * 1.001f);
  }
}

// Whatever bytes come: no more than the picture is unpacked, and what is wrong is said to be.
TEST(DisparityCode, DamagedBytesAreRefusedOrAPicture) {
  const std::vector<uint8_t> good = encoded(picture(room));
  std::vector<float> found;
  EXPECT_FALSE(decode_disparity({}, width, height, unit, found));
  EXPECT_FALSE(decode_disparity(good, width, height + 1, unit, found));
  EXPECT_FALSE(decode_disparity(good, width - 1, height, unit, found));
  for (size_t length = 0; length < good.size(); length++)
    EXPECT_FALSE(decode_disparity(std::span(good).first(length), width, height, unit, found));
  int refused = 0;
  for (size_t i = 0; i < good.size(); i++) {
    std::vector<uint8_t> bad = good;
    bad[i] ^= 0x55;
    refused += !decode_disparity(bad, width, height, unit, found);
  }
  EXPECT_GT(refused, int(good.size()) * 9 / 10);  // deflate has a checksum
}

// The bytes that the page's test reads, too.
TEST(DisparityCode, ReadsTheGoldenBytes) {
  const Packet golden = test::read_golden("keyframe.hex");
  const std::span<const uint8_t> code = std::span(golden).subspan(keyframe_header_bytes + 4);
  std::vector<float> found;
  ASSERT_TRUE(decode_disparity(code, 8, 4, 1, found));
  const std::vector<float> wanted = {10, 15, 20, 25,  30, 35, 300, 7,  20, 25,   30,
                                     35, 40, 45, 300, 7,  30, 35,  40, 45, 50,   55,
                                     60, 9,  40, 45,  50, 55, 60,  65, 70, 65535};
  EXPECT_EQ(found, wanted);
}

TEST(DisparityCode, RefusesTooFewDisparities) {
  std::vector<uint8_t> bytes;
  EXPECT_THROW(encode_disparity(std::vector<float>(5), 3, 2, unit, bytes), std::invalid_argument);
  EXPECT_THROW(encode_disparity(std::vector<float>(6), 3, 2, 0, bytes), std::invalid_argument);
}

}  // namespace
}  // namespace wellspring::test
