// SPDX-License-Identifier: Apache-2.0
#include "volume/compressed/to_volume.h"

#include <gtest/gtest.h>

#include <cstring>

#include "volume/compressed/compress.h"

namespace wellspring::test {
namespace {

// Returns a volume of two kinds of blocks, which codebooks of two codevectors tell without a loss.
Volume two_kinds(glm::ivec3 size) {
  Volume volume;
  volume.size = size, volume.kind = SampleKind::u16;
  volume.slope = 0.5, volume.intercept = -20;
  volume.to_metres[3] = glm::dvec4(1, 2, 3, 1);
  const std::shared_ptr<std::byte[]> bytes(new std::byte[volume.byte_count()]);
  auto* samples = reinterpret_cast<uint16_t*>(bytes.get());
  for (int z = 0; z < size.z; z++)
    for (int y = 0; y < size.y; y++)
      for (int x = 0; x < size.x; x++) *samples++ = (x / 4 + y / 4 + z / 4) % 2 == 0 ? 1200 : 400;
  volume.bytes = std::shared_ptr<const std::byte>(bytes, bytes.get());
  return volume;
}

TEST(CompressedToVolume, WhatIsDecodedMeasuresAndLiesAsBefore) {
  const Volume before = two_kinds({20, 12, 70});
  const CompressedVolume compressed = compress_volume(before, {.levels = 1, .codevectors = 4});
  const Volume after = to_volume(compressed);
  ASSERT_EQ(after.size, before.size);
  EXPECT_EQ(after.to_metres, before.to_metres);
  for (const glm::ivec3 at : {glm::ivec3(0), glm::ivec3(5, 11, 69), glm::ivec3(19, 3, 33)})
    EXPECT_NEAR(after.at(at.x, at.y, at.z), before.at(at.x, at.y, at.z), 0.5);
}

TEST(CompressedToVolume, CoarserSamplesLieAmongThoseTheyAreTheMeanOf) {
  const CompressedVolume compressed =
      compress_volume(two_kinds({16, 16, 16}), {.levels = 1, .codevectors = 4});
  const Volume half = to_volume(compressed, 1);
  ASSERT_EQ(half.size, glm::ivec3(8));
  EXPECT_EQ(half.to_metres * glm::dvec4(0, 0, 0, 1), glm::dvec4(1.5, 2.5, 3.5, 1));
  EXPECT_EQ(half.to_metres * glm::dvec4(1, 0, 0, 0), glm::dvec4(2, 0, 0, 0));
  EXPECT_NEAR(half.at(0, 0, 0), 580, 0.5);
  EXPECT_NEAR(half.at(2, 0, 0), 180, 0.5);
}

}  // namespace
}  // namespace wellspring::test
