// SPDX-License-Identifier: Apache-2.0
#include "image/image.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <thread>

#include "base/load_error.h"

namespace wellspring::test {
namespace {

Image8 gradient(int width, int height) {
  Image8 image{width, height, {}};
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++) {
      image.rgb.push_back(uint8_t(255 * x / width));
      image.rgb.push_back(uint8_t(255 * y / height));
      image.rgb.push_back(uint8_t(128));
    }
  return image;
}

int largest_difference(const Image8& a, const Image8& b) {
  int largest = 0;
  for (size_t i = 0; i < a.rgb.size(); i++)
    largest = std::max(largest, std::abs(a.rgb[i] - b.rgb[i]));
  return largest;
}

TEST(Jpeg, RoundTripIsCloseAndTheRightWayUp) {
  Image8 image = gradient(123, 77);
  std::vector<uint8_t> bytes;
  for (bool full_chroma : {false, true}) {
    encode_jpeg(image, 95, full_chroma, bytes);
    Image8 back = decode_jpeg(bytes, "memory");
    ASSERT_EQ(back.width, 123);
    ASSERT_EQ(back.height, 77);
    EXPECT_LE(largest_difference(image, back), 12) << "full chroma " << full_chroma;
  }
}

TEST(Jpeg, FullChromaKeepsFineColor) {
  Image8 stripes{64, 64, {}};
  for (int i = 0; i < 64 * 64; i++) {
    stripes.rgb.push_back(i % 2 ? 255 : 0);
    stripes.rgb.push_back(0);
    stripes.rgb.push_back(i % 2 ? 0 : 255);
  }
  std::vector<uint8_t> bytes;
  encode_jpeg(stripes, 95, true, bytes);
  int full = largest_difference(stripes, decode_jpeg(bytes, "memory"));
  encode_jpeg(stripes, 95, false, bytes);
  int half = largest_difference(stripes, decode_jpeg(bytes, "memory"));
  EXPECT_LT(full, 30);
  EXPECT_GT(half, 60);
}

TEST(Jpeg, QualityOrdersSizesAndOddValuesAreClamped) {
  Image8 image = gradient(200, 200);
  for (size_t i = 0; i < image.rgb.size(); i++) image.rgb[i] ^= uint8_t((i * 2654435761u) >> 27);
  std::vector<uint8_t> low, high, lowest, beyond;
  encode_jpeg(image, 20, false, low);
  encode_jpeg(image, 90, false, high);
  encode_jpeg(image, 1, false, lowest);
  encode_jpeg(image, -5, false, beyond);
  EXPECT_LT(low.size(), high.size());
  EXPECT_EQ(lowest, beyond);
}

TEST(Jpeg, ThreadsDoNotShareState) {
  Image8 small = gradient(64, 48), large = gradient(320, 200);
  std::vector<uint8_t> expected_small, expected_large;
  encode_jpeg(small, 80, false, expected_small);
  encode_jpeg(large, 60, true, expected_large);
  std::vector<std::thread> threads;
  std::atomic<int> wrong{0};
  for (int t = 0; t < 4; t++)
    threads.emplace_back([&, t] {
      std::vector<uint8_t> out;
      for (int i = 0; i < 20; i++) {
        encode_jpeg(t % 2 ? small : large, t % 2 ? 80 : 60, t % 2 == 0, out);
        wrong += out != (t % 2 ? expected_small : expected_large);
      }
    });
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
}

// A picture may follow what is in front of it, and nothing of a longer one before stays.
TEST(Jpeg, FollowsWhatIsSkipped) {
  std::vector<uint8_t> alone, behind{1, 2, 3};
  encode_jpeg(gradient(64, 48), 90, true, behind, 3);
  for (int quality : {90, 20}) {
    encode_jpeg(gradient(64, 48), quality, true, alone);
    encode_jpeg(gradient(64, 48), quality, true, behind, 3);
    ASSERT_EQ(behind.size(), alone.size() + 3);
    EXPECT_TRUE(std::equal(alone.begin(), alone.end(), behind.begin() + 3));
    EXPECT_EQ(std::vector<uint8_t>(behind.begin(), behind.begin() + 3),
              (std::vector<uint8_t>{1, 2, 3}));
  }
}

TEST(Jpeg, WhatIsNoJpegIsRefusedByName) {
  Image8 image = gradient(40, 40);
  std::vector<uint8_t> bytes;
  encode_jpeg(image, 80, false, bytes);
  std::vector<uint8_t> cut(bytes.begin(), bytes.begin() + long(bytes.size() / 2)), noise(100, 7);
  for (const auto& bad : {cut, noise, std::vector<uint8_t>{}}) {
    try {
      decode_jpeg(bad, "visitor.jpg");
      ADD_FAILURE() << "accepted " << bad.size() << " bytes";
    } catch (const LoadError& error) {
      EXPECT_EQ(error.file, "visitor.jpg");
    }
  }
  EXPECT_THROW(encode_jpeg(Image8{}, 80, false, bytes), std::invalid_argument);
  EXPECT_THROW(encode_jpeg(Image8{10, 10, {1, 2, 3}}, 80, false, bytes), std::invalid_argument);
}

}  // namespace
}  // namespace wellspring::test
