// SPDX-License-Identifier: Apache-2.0
#include "volume/compressed/compress.h"

#include <gtest/gtest.h>

#include <limits>
#include <oneapi/tbb/global_control.h>
#include <set>
#include <stdexcept>

#include "compressed_made.h"
#include "volume/compressed/block_source.h"
#include "volume/compressed/compressed_volume.h"
#include "volume/compressed/coding_loss.h"
#include "volume/compressed/rgb_word.h"

namespace wellspring::test {
namespace {

std::vector<std::byte> file_of(const CompressedVolume& volume) {
  return {volume.file.get(), volume.file.get() + volume.file_bytes};
}

TEST(CompressedRgbWord, ColoursKeepTheirQuartersAndHalves) {
  for (const glm::vec3 color : {glm::vec3(0), glm::vec3(255), glm::vec3(-256, 255.75f, -256),
                                glm::vec3(255.75f, -256, 255.5f), glm::vec3(-0.25f, 0.25f, -0.5f)})
    EXPECT_EQ(from_rgb_word(to_rgb_word(color)), color);
  EXPECT_EQ(from_rgb_word(to_rgb_word({1000, -1000, 300})), glm::vec3(255.75f, -256, 255.5f));
}

TEST(CompressedRgbWord, SumsOfWordsAreSumsOfColours) {
  Rng random(3);
  for (int i = 0; i < 1000; i++) {
    const auto any = [&](float most) {
      return glm::floor((glm::vec3(random.uniform(), random.uniform(), random.uniform()) - 0.5f) *
                        most);
    };
    const glm::vec3 first = any(200) + 120.f, second = any(100), third = any(100);
    const uint32_t sum = to_rgb_word(first) + rgb_bias + to_rgb_word(second) + to_rgb_word(third);
    EXPECT_EQ(from_biased_rgb(sum), first + second + third);
  }
}

TEST(Compress, CodesHaveTheSizeOfTheFormula) {
  // The paper's 402x224x1297 blocks leave out the last of 5189 slices, which we keep.
  EXPECT_EQ(blocks_of({1608, 896, 5188}), glm::ivec3(402, 224, 1297));
  EXPECT_EQ(code_bytes({1608, 896, 5188}, 4, 4096), 700753536u);
  EXPECT_EQ(code_bytes({1608, 896, 5189}, 4, 4096), 402u * 224 * 1298 * 6);
  EXPECT_EQ(code_bytes({12, 4, 4}, 2, 5), 3u);  // three codes of twice three bits
  EXPECT_EQ(code_bytes({8, 8, 8}, 3, 1 << 16), 8u * 6);
  const Box brick = brick_box({1, 2, 3}, 0, 4);
  EXPECT_EQ(brick.first, glm::ivec3(28, 60, 92));
  EXPECT_EQ(brick.size, glm::ivec3(40));
  EXPECT_NEAR(std::pow(136 / 128.0, 3), 1.1995, 5e-5);
}

TEST(Compress, AFurtherLevelMakesNoBlockWorse) {
  for (const bool colored : {true, false}) {
    Volume volume = colored_ball({40, 33, 29});
    if (!colored) {
      Rng random(2);
      volume = made_volume<uint16_t>({40, 33, 29}, 1, [&](int x, int y, int, int) {
        return 500 * x + 300 * y + 4000 * random.uniform();
      });
    }
    double before = std::numeric_limits<double>::infinity();
    for (int levels = 1; levels <= 5; levels++) {
      const CompressedVolume compressed = compress_volume(volume, few_codevectors(16, levels));
      const double error = compare_compressed(volume, compressed).mean_square;
      EXPECT_LT(error, before) << levels;
      before = error;
    }
  }
}

TEST(Compress, MoreCodevectorsLoseLess) {
  const Volume volume = colored_ball({36, 36, 36});
  double before = 0;
  for (const int codevectors : {2, 8, 32, 128}) {
    const CompressedVolume compressed = compress_volume(volume, few_codevectors(codevectors));
    const double decibel = compare_compressed(volume, compressed).decibel;
    EXPECT_GT(decibel, before);
    before = decibel;
  }
}

TEST(Compress, NothingIsLostWhereEveryDistinctBlockHasACodevector) {
  Rng random(5);
  std::vector<uint8_t> blocks(20 * 192);
  for (uint8_t& sample : blocks) sample = uint8_t(random.next() >> 24);
  const Volume volume =
      made_volume<uint8_t>({24, 20, 28}, 3, [&](int x, int y, int z, int channel) {
        const int block = (x / 4 * 7 + y / 4 * 3 + z / 4 * 11) % 20;
        return blocks[size_t((((block * 4 + z % 4) * 4 + y % 4) * 4 + x % 4) * 3 + channel)];
      });
  const CompressedVolume compressed = compress_volume(volume, few_codevectors(20));
  EXPECT_EQ(compressed.codevectors, 20);
  EXPECT_EQ(decode_all<uint8_t>(compressed), samples_of<uint8_t>(volume));
  EXPECT_EQ(compare_compressed(volume, compressed).decibel,
            std::numeric_limits<double>::infinity());
  EXPECT_LT(compare_compressed(volume, compress_volume(volume, few_codevectors(19, 1))).decibel,
            100);
}

TEST(Compress, SizesNeedNotBeMultiplesOfABlock) {
  for (const glm::ivec3 size : {glm::ivec3(1), glm::ivec3(5, 1, 2), glm::ivec3(7, 9, 3),
                                glm::ivec3(1, 1, 40), glm::ivec3(8, 4, 12)}) {
    const Volume colored = made_volume<uint8_t>(size, 3, [](int x, int y, int z, int channel) {
      return 7 * x + 11 * y + 5 * z + 60 * channel;
    });
    EXPECT_EQ(decode_all<uint8_t>(compress_volume(colored)), samples_of<uint8_t>(colored));
    const Volume grey = made_volume<int16_t>(
        size, 1, [](int x, int y, int z, int) { return 777 * x - 1000 * y + z; });
    EXPECT_EQ(decode_all<int16_t>(compress_volume(grey)), samples_of<int16_t>(grey));
  }
}

TEST(Compress, SixteenBitsKeepTheirExtremes) {
  const auto extremes = [](auto least, auto most) {
    return [=](int x, int y, int z, int) { return ((x + y * 3 + z) & 1) ? most : least; };
  };
  const Volume unsigned_one = made_volume<uint16_t>({9, 6, 5}, 1, extremes(0, 65535));
  EXPECT_EQ(decode_all<uint16_t>(compress_volume(unsigned_one)),
            samples_of<uint16_t>(unsigned_one));
  const Volume signed_one = made_volume<int16_t>({9, 6, 5}, 1, extremes(-32768, 32767));
  const CompressedVolume compressed = compress_volume(signed_one);
  EXPECT_EQ(decode_all<int16_t>(compressed), samples_of<int16_t>(signed_one));
  // Few codevectors: residuals span more than 16 bits.
  Rng random(8);
  const Volume noise = made_volume<uint16_t>(
      {24, 24, 24}, 1, [&](int, int, int, int) { return random.next() & 1 ? 65535 : 0; });
  const CompressedVolume coded = compress_volume(noise, few_codevectors(8));
  const CodingLoss deviation = compare_compressed(noise, coded);
  EXPECT_LT(deviation.mean_square, 32768.0 * 32768.0);
}

TEST(Compress, ColoursFarOffWrapAroundNowhere) {
  // Extreme noise: residuals of blocks that were not trained on are as large as can be.
  Rng random(9);
  const Volume volume = made_volume<uint8_t>(
      {64, 64, 32}, 3, [&](int, int, int, int) { return random.next() & 1 ? 255 : 0; });
  CompressionSettings settings = few_codevectors(64);
  settings.training_share = 0.01, settings.least_training_blocks = 80;
  const CompressedVolume compressed = compress_volume(volume, settings);
  const std::vector<float> exact = decode_all<float>(compressed);
  EXPECT_GE(*std::min_element(exact.begin(), exact.end()), -127);
  EXPECT_LE(*std::max_element(exact.begin(), exact.end()), 382);
  settings.levels = 1;
  EXPECT_LE(compare_compressed(volume, compressed).mean_square,
            compare_compressed(volume, compress_volume(volume, settings)).mean_square);
}

TEST(Compress, BackgroundIsLeftOutAndBecomesFlat) {
  Volume volume = made_volume<int16_t>({32, 16, 16}, 1, [](int x, int y, int z, int) {
    return x < 16 ? -1000 + (x * y + z) % 5 : 40 * x + 13 * y + 7 * z;
  });
  volume.slope = 2, volume.intercept = 5;
  CompressionSettings settings = few_codevectors(256);
  settings.background = -900;
  const CompressedVolume compressed = compress_volume(volume, settings);
  const CodingLoss deviation = compare_compressed(volume, compressed, settings.background);
  EXPECT_EQ(deviation.background, 4u * 4 * 4);
  EXPECT_EQ(deviation.foreground, 4u * 4 * 4);
  EXPECT_EQ(deviation.mean_square, 0);
  const std::vector<int16_t> samples = decode_all<int16_t>(compressed);
  std::set<int16_t> seen;
  for (size_t i = 0; i < samples.size(); i++)
    if (i % 32 < 16) seen.insert(samples[i]);
  EXPECT_EQ(seen, std::set<int16_t>{-998});
  EXPECT_EQ(compressed.slope, 2);
  EXPECT_EQ(compressed.intercept, 5);
}

TEST(Compress, AnEmptyVolumeNeedsNoCodes) {
  const Volume volume = made_volume<uint8_t>({50, 40, 30}, 3, [](int, int, int, int) { return 0; });
  const CompressedVolume compressed = compress_volume(volume);
  EXPECT_EQ(compressed.codevectors, 1);
  EXPECT_EQ(code_bytes(volume.size, 4, 1), 0u);
  EXPECT_EQ(decode_all<uint8_t>(compressed), samples_of<uint8_t>(volume));
}

TEST(Compress, OtherKindsAreBroughtToSixteenBits) {
  const Volume volume = made_volume<float>({12, 10, 9}, 1, [](int x, int y, int z, int) {
    return x == 3 && y == 4 ? std::nanf("") : 0.25f * float(x) - 0.125f * float(y * z);
  });
  const CompressedVolume compressed = compress_volume(volume);
  EXPECT_EQ(compressed.kind, SampleKind::u16);
  const std::vector<float> measured = decode_all<float>(compressed);
  const std::vector<float> wanted = samples_of<float>(volume);
  for (size_t i = 0; i < wanted.size(); i++)
    if (std::isfinite(wanted[i])) EXPECT_NEAR(measured[i], wanted[i], 2e-4f) << i;
    else EXPECT_NEAR(measured[i], -9, 1e-3f);  // the least
}

TEST(Compress, TheFileDependsOnTheSeedAloneNotOnThreads) {
  const Volume volume = colored_ball({48, 40, 36});
  CompressionSettings settings = few_codevectors(48);
  const std::vector<std::byte> many = file_of(compress_volume(volume, settings));
  {
    const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(file_of(compress_volume(volume, settings)), many);
  }
  settings.seed = 2;
  EXPECT_NE(file_of(compress_volume(volume, settings)), many);
}

TEST(Compress, ProgressRisesToItsEnd) {
  double last = 0;
  compress_volume(colored_ball({40, 40, 40}), few_codevectors(16), [&](double part) {
    EXPECT_GE(part, last);
    last = part;
  });
  EXPECT_NEAR(last, 1, 1e-9);
}

TEST(Compress, WrongSettingsAndVolumesAreRefused) {
  const Volume volume = colored_ball({8, 8, 8});
  EXPECT_THROW(compress_volume(volume, few_codevectors(0)), std::invalid_argument);
  EXPECT_THROW(compress_volume(volume, few_codevectors(1 << 17)), std::invalid_argument);
  EXPECT_THROW(compress_volume(volume, few_codevectors(4096, 5)), std::invalid_argument);
  EXPECT_THROW(compress_volume(volume, few_codevectors(16, 9)), std::invalid_argument);
  EXPECT_THROW(compress_volume(Volume{}), std::invalid_argument);
  EXPECT_THROW(
      compress_volume(made_volume<uint16_t>({4, 4, 4}, 3, [](int, int, int, int) { return 1; })),
      std::invalid_argument);
}

}  // namespace
}  // namespace wellspring::test
