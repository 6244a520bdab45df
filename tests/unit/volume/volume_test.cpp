// SPDX-License-Identifier: Apache-2.0
#include "volume/volume.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

namespace wellspring::test {
namespace {

template <class Sample>
Volume volume_of(glm::ivec3 size, SampleKind kind, const std::vector<Sample>& samples,
                 int channels = 1) {
  Volume volume;
  volume.size = size, volume.kind = kind, volume.channels = channels;
  const std::shared_ptr<std::byte[]> bytes(new std::byte[samples.size() * sizeof(Sample)]);
  std::memcpy(bytes.get(), samples.data(), samples.size() * sizeof(Sample));
  volume.bytes = std::shared_ptr<const std::byte>(bytes, bytes.get());
  return volume;
}

TEST(Volume, SamplesMeasureSlopeTimesThemPlusIntercept) {
  Volume volume = volume_of<int16_t>({2, 1, 2}, SampleKind::i16, {-1000, 0, 7, 32767});
  volume.slope = 0.5, volume.intercept = -24;
  EXPECT_EQ(volume.at(0, 0, 0), -524);
  EXPECT_EQ(volume.at(1, 0, 1), 16359.5);
}

TEST(Volume, ColoursLieSideBySide) {
  const Volume volume = volume_of<uint8_t>({1, 2, 1}, SampleKind::u8, {1, 2, 3, 4, 5, 6}, 3);
  EXPECT_EQ(volume.at(0, 1, 0, 2), 6);
  EXPECT_EQ(to_grid(volume, 1).values, (std::vector<float>{2, 5}));
}

TEST(Volume, AGridOfFloatsIsFinite) {
  const float infinite = std::numeric_limits<float>::infinity();
  const Volume volume =
      volume_of<float>({4, 1, 1}, SampleKind::f32, {infinite, -infinite, std::nanf(""), 1e30f});
  EXPECT_EQ(to_grid(volume).values, (std::vector<float>{0, 0, 0, 1e30f}));
}

}  // namespace
}  // namespace wellspring::test
