// SPDX-License-Identifier: Apache-2.0
#include "volume/compressed/opacity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "compressed_made.h"
#include "volume/compressed/fetch.h"

namespace wellspring::test {
namespace {

OpacityTable random_table(int side, uint64_t seed) {
  Rng random(seed);
  return OpacityTable(side, [&](glm::vec3) { return std::pow(random.uniform(), 8.f); });
}

TEST(CompressedOpacity, TablesAreLookedUpByColour) {
  const auto ramp = [](glm::vec3 color) {
    return (color.x + 2 * color.y + 4 * color.z) / (7 * 255);
  };
  const OpacityTable table(32, ramp);
  for (const glm::vec3 color : {glm::vec3(0), glm::vec3(255), glm::vec3(255, 0, 0),
                                glm::vec3(12, 200, 77), glm::vec3(254.9f, 3, 128)}) {
    EXPECT_NEAR(table.trilinear(color), ramp(color), 1e-5f);
    EXPECT_NEAR(table.nearest(color), ramp(color), 0.5f / 31 + 1e-5f);
  }
  EXPECT_EQ(table.nearest({300, -20, 0}), table.nearest({255, 0, 0}));
  EXPECT_EQ(OpacityTable(2, [](glm::vec3) { return 7.f; }).trilinear({9, 9, 9}), 1);
  EXPECT_THROW(OpacityTable(1, ramp), std::invalid_argument);
}

TEST(CompressedOpacity, LongerVoxelsHideMore) {
  const OpacityTable table(8, [](glm::vec3 color) { return color.x / 510; });
  const OpacityTable twice = table.stretched(2);
  for (const float red : {0.f, 255.f}) {
    const float clear = 1 - table.nearest({red, 0, 0});
    EXPECT_NEAR(twice.nearest({red, 0, 0}), 1 - clear * clear, 1e-6f);
  }
  EXPECT_NEAR(twice.greatest(glm::vec3(0), glm::vec3(255)), 0.75f, 1e-6f);
}

TEST(CompressedOpacity, TheGreatestOfABoxIsTheGreatestOfItsColours) {
  for (const int side : {5, 32}) {
    const OpacityTable table = random_table(side, 2);
    const float step = 255.f / float(side - 1);
    Rng random(3);
    for (int i = 0; i < 100; i++) {
      const auto any = [&] {
        return glm::floor(glm::vec3(random.uniform(), random.uniform(), random.uniform()) *
                          float(side));
      };
      const glm::vec3 a = any(), b = any(), least = glm::min(a, b), most = glm::max(a, b);
      const auto greatest_within = [&](glm::vec3 low, glm::vec3 high) {
        float found = 0;
        for (float z = low.z; z <= high.z; z++)
          for (float y = low.y; y <= high.y; y++)
            for (float x = low.x; x <= high.x; x++)
              found = std::max(found, table.nearest(glm::vec3(x, y, z) * step));
        return found;
      };
      // Interpolation reaches to the colours beside the box.
      const float found = table.greatest(least * step, most * step);
      EXPECT_GE(found, greatest_within(least, most));
      EXPECT_LE(found,
                greatest_within(glm::max(least - 1.f, 0.f), glm::min(most + 1.f, float(side - 1))));
    }
  }
}

// Half of the bricks are dull and half are bright; a thread of bright ones crosses the dull.
Volume dull_and_bright() {
  Rng random(4);
  return made_volume<uint8_t>({128, 64, 64}, 3, [&](int x, int y, int z, int channel) {
    const bool bright = x >= 70 || (std::abs(y - 40) < 3 && std::abs(z - 20) < 3);
    return (bright ? 200 : 60) + 20 * random.uniform() - 10 * float(channel);
  });
}

TEST(CompressedOpacity, CulledBricksHoldNothingThatIsSeen) {
  const CompressedVolume volume = compress_volume(dull_and_bright(), few_codevectors(64));
  constexpr float threshold = 0.02f;
  const OpacityTable bright(
      32, [](glm::vec3 color) { return std::clamp((color.x - 120) / 100, 0.f, 0.5f); });
  int culled = 0;
  const glm::ivec3 bricks = bricks_of(volume.size);
  for (int i = 0; i < bricks.x * bricks.y * bricks.z; i++) {
    const glm::ivec3 brick(i % bricks.x, i / bricks.x % bricks.y, i / bricks.x / bricks.y);
    const float bound = opacity_bound(volume, bright, brick);
    culled += bound < threshold;
    float seen = 0;
    for (int detail = 0; detail < details; detail++) {
      const Box box = brick_box(brick, detail, 1);
      std::vector<uint8_t> samples(size_t(3 * box.size.x * box.size.y * box.size.z));
      decode(std::span<uint8_t>(samples), volume, detail, box);
      for (size_t k = 0; k < samples.size(); k += 3) {
        const glm::vec3 color(samples[k], samples[k + 1], samples[k + 2]);
        seen = std::max({seen, bright.nearest(color), bright.trilinear(color)});
      }
    }
    EXPECT_LE(seen, bound + 1e-6f) << i;
    EXPECT_TRUE(bound < threshold || seen > threshold) << i;  // the bound is no idle one
  }
  EXPECT_EQ(culled, 8 - 2);
}

// Looks along x through all voxels of a line; bricks whose bound is below the threshold are clear.
float light_through(const CompressedVolume& volume, const OpacityTable& table, int y, int z,
                    float threshold) {
  float light = 1;
  for (int x = 0; x < volume.size.x; x++)
    if (opacity_bound(volume, table, glm::ivec3(x, y, z) / brick_side) >= threshold)
      light *= 1 - table.trilinear(fetch(volume, {x, y, z}));
  return light;
}

TEST(CompressedOpacity, PicturesWithAndWithoutCullingAgreeWithinTheThreshold) {
  const CompressedVolume volume = compress_volume(dull_and_bright(), few_codevectors(64));
  constexpr float threshold = 0.001f;
  const OpacityTable table(32, [](glm::vec3 color) { return color.x < 100 ? 0.0005f : 0.02f; });
  bool differs = false;
  for (int y = 5; y < 64; y += 20)
    for (int z = 5; z < 64; z += 20) {
      const float all = light_through(volume, table, y, z, 0);
      const float some = light_through(volume, table, y, z, threshold);
      // Each of 64 voxels of two culled bricks hides less than the threshold.
      EXPECT_GE(some, all);
      EXPECT_LE(some - all, 64 * threshold);
      differs = differs || some != all;
    }
  EXPECT_TRUE(differs);
}

}  // namespace
}  // namespace wellspring::test
