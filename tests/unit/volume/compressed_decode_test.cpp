// SPDX-License-Identifier: Apache-2.0
#include "volume/compressed/decode.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "compressed_made.h"
#include "volume/compressed/compressed_volume.h"
#include "volume/compressed/fetch.h"

namespace wellspring::test {
namespace {

Volume grey_hills(glm::ivec3 size) {
  Rng random(4);
  Volume volume = made_volume<uint16_t>(size, 1, [&](int x, int y, int z, int) {
    return 20000 + 9000 * std::sin(0.2 * x + 0.1 * z) * std::cos(0.3 * y) +
           3000 * double(random.uniform());
  });
  volume.slope = 0.25, volume.intercept = -100;
  return volume;
}

// Decodes at 1:1 and takes means of 2^3 or 4^3 voxels, of a box of whole blocks.
std::vector<float> filter_boxes(const CompressedVolume& volume, int detail) {
  const glm::ivec3 size = 4 * volume.blocks(), coarse = size / (1 << detail);
  std::vector<float> fine(size_t(size.x) * size_t(size.y) * size_t(size.z) *
                          size_t(volume.channels));
  decode(std::span<float>(fine), volume, 0, Box{glm::ivec3(0), size});
  std::vector<double> sums(fine.size() >> 3 * detail);
  size_t i = 0;
  for (int z = 0; z < size.z; z++)
    for (int y = 0; y < size.y; y++)
      for (int x = 0; x < size.x; x++)
        for (int channel = 0; channel < volume.channels; channel++) {
          const glm::ivec3 at = glm::ivec3(x, y, z) >> detail;
          sums[size_t(((at.z * coarse.y + at.y) * coarse.x + at.x) * volume.channels + channel)] +=
              double(fine[i++]);
        }
  std::vector<float> means;
  for (const double sum : sums) means.push_back(float(sum / double(1 << 3 * detail)));
  return means;
}

TEST(CompressedDecode, FilteredCodebooksDecodeToFilteredVoxels) {
  for (const bool colored : {true, false}) {
    const Volume volume = colored ? colored_ball({36, 28, 24}) : grey_hills({36, 28, 24});
    const CompressedVolume compressed = compress_volume(volume, few_codevectors(40));
    for (const int detail : {1, 2}) {
      const std::vector<float> wanted = filter_boxes(compressed, detail);
      const std::vector<float> decoded = decode_all<float>(compressed, detail);
      ASSERT_EQ(decoded.size(), wanted.size());
      const float tolerance = colored ? 0 : 0.002f;  // sums of quarters are exact in floats
      for (size_t i = 0; i < wanted.size(); i++) EXPECT_NEAR(decoded[i], wanted[i], tolerance) << i;
    }
  }
}

TEST(CompressedDecode, CoarseVoxelsOfTheLastBlocksCountTheirWholeBlock) {
  const CompressedVolume compressed = compress_volume(grey_hills({5, 6, 7}), few_codevectors(3));
  EXPECT_EQ(size_at(compressed, 1), glm::ivec3(3, 3, 4));
  EXPECT_EQ(size_at(compressed, 2), glm::ivec3(2, 2, 2));
  EXPECT_EQ(decode_all<float>(compressed, 2).size(), 8u);
}

// Codes of whole samples are the exact ones, rounded and cut.
template <class Sample>
void expect_rounded(const CompressedVolume& volume, int detail) {
  const std::vector<float> exact = decode_all<float>(volume, detail);
  const std::vector<Sample> rounded = decode_all<Sample>(volume, detail);
  constexpr double least = std::numeric_limits<Sample>::min();
  constexpr double most = std::numeric_limits<Sample>::max();
  for (size_t i = 0; i < exact.size(); i++) {
    const double sum = (double(exact[i]) - volume.intercept) / volume.slope;
    EXPECT_NEAR(double(rounded[i]), std::clamp(sum, least, most), 0.505) << i;
    if (volume.channels == 3 && detail == 0) {
      EXPECT_EQ(double(rounded[i]), std::floor(std::clamp(sum, least, most) + 0.5)) << i;
    }
  }
}

TEST(CompressedDecode, SamplesAreRoundedAndCut) {
  Rng random(6);
  const Volume hard = made_volume<uint8_t>({30, 30, 30}, 3, [&](int x, int, int, int) {
    return x < 15 ? (random.next() & 1 ? 255 : 0) : x * 8;
  });
  for (const int levels : {1, 3, 4}) {
    const CompressedVolume colored = compress_volume(hard, few_codevectors(24, levels));
    for (int detail = 0; detail < details; detail++) expect_rounded<uint8_t>(colored, detail);
  }
  const CompressedVolume grey = compress_volume(grey_hills({20, 20, 20}), few_codevectors(8));
  for (int detail = 0; detail < details; detail++) expect_rounded<uint16_t>(grey, detail);
}

TEST(CompressedDecode, AnyBoxHasTheVoxelsOfTheWholeAndRepeatsTheEdge) {
  for (const bool colored : {true, false}) {
    const Volume volume = colored ? colored_ball({22, 19, 17}) : grey_hills({22, 19, 17});
    const CompressedVolume compressed = compress_volume(volume, few_codevectors(12));
    const int channels = compressed.channels;
    for (int detail = 0; detail < details; detail++) {
      const glm::ivec3 size = size_at(compressed, detail);
      const std::vector<float> whole = decode_all<float>(compressed, detail);
      for (const Box box : {Box{{-4, -4, -4}, {32, 30, 28}}, Box{{1, 2, 3}, {2, 3, 1}},
                            Box{{3, -2, 0}, {1, 4, 9}}, Box{{2, 2, 2}, {40, 2, 2}}}) {
        std::vector<float> part(size_t(box.size.x * box.size.y * box.size.z * channels));
        decode(std::span<float>(part), compressed, detail, box);
        size_t i = 0;
        for (int z = 0; z < box.size.z; z++)
          for (int y = 0; y < box.size.y; y++)
            for (int x = 0; x < box.size.x; x++)
              for (int channel = 0; channel < channels; channel++) {
                const glm::ivec3 at =
                    glm::clamp(box.first + glm::ivec3(x, y, z), glm::ivec3(0), size - 1);
                const int from = ((at.z * size.y + at.y) * size.x + at.x) * channels + channel;
                ASSERT_EQ(part[i++], whole[size_t(from)]) << detail << " " << x << " " << y;
              }
      }
    }
  }
}

TEST(CompressedDecode, WrongBoxesAndKindsAreRefused) {
  const CompressedVolume volume = compress_volume(colored_ball({8, 8, 8}), few_codevectors(4));
  std::vector<uint8_t> samples(3 * 64);
  const auto place = std::span<uint8_t>(samples);
  EXPECT_NO_THROW(decode(place, volume, 0, Box{{0, 0, 0}, {4, 4, 4}}));
  EXPECT_THROW(decode(place, volume, 0, Box{{8, 0, 0}, {4, 4, 4}}), std::invalid_argument);
  EXPECT_THROW(decode(place, volume, 0, Box{{0, 0, 0}, {4, 4, 5}}), std::invalid_argument);
  EXPECT_THROW(decode(place, volume, 3, Box{{0, 0, 0}, {4, 4, 4}}), std::invalid_argument);
  std::vector<uint16_t> other(3 * 64);
  EXPECT_THROW(decode(std::span<uint16_t>(other), volume, 0, Box{{0, 0, 0}, {4, 4, 4}}),
               std::invalid_argument);
}

TEST(CompressedFetch, AVoxelIsTheDecodedOne) {
  for (const bool colored : {true, false}) {
    const Volume volume = colored ? colored_ball({13, 11, 9}) : grey_hills({13, 11, 9});
    const CompressedVolume compressed = compress_volume(volume, few_codevectors(6));
    const std::vector<float> whole = decode_all<float>(compressed);
    size_t i = 0;
    for (int z = 0; z < 9; z++)
      for (int y = 0; y < 11; y++)
        for (int x = 0; x < 13; x++) {
          const glm::vec3 fetched = fetch(compressed, {x, y, z});
          for (int channel = 0; channel < compressed.channels; channel++)
            ASSERT_EQ(fetched[channel], whole[i++]);
        }
    EXPECT_EQ(fetch(compressed, {-3, 20, 5}), fetch(compressed, {0, 10, 5}));
  }
}

TEST(CompressedFetch, BetweenVoxelsIsTheirTrilinearMean) {
  const CompressedVolume compressed =
      compress_volume(colored_ball({13, 11, 9}), few_codevectors(16));
  const auto near = [&](glm::vec3 position, glm::vec3 wanted) {
    const glm::vec3 found = fetch_between(compressed, position);
    for (int i = 0; i < 3; i++) EXPECT_NEAR(found[i], wanted[i], 1e-3f);
  };
  const auto at = [&](int x, int y, int z) { return fetch(compressed, {x, y, z}); };
  near({5, 6, 7}, at(5, 6, 7));
  near({3.25f, 6, 7}, at(3, 6, 7) * 0.75f + at(4, 6, 7) * 0.25f);  // two blocks'
  near({5, 3.5f, 2}, (at(5, 3, 2) + at(5, 4, 2)) * 0.5f);
  glm::vec3 eight(0);
  for (int i = 0; i < 8; i++) eight += at(3 + (i & 1), 7 + (i >> 1 & 1), 3 + (i >> 2)) / 8.f;
  near({3.5f, 7.5f, 3.5f}, eight);
  near({-1, 4, 100}, at(0, 4, 8));
}

}  // namespace
}  // namespace wellspring::test
