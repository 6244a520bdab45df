// SPDX-License-Identifier: Apache-2.0
#include "benchmark/picture_pair.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace wellspring::test {
namespace {

// Radiance 1 with Gaussian noise, brighter by `step` in the left half.
Frame noisy(uint32_t seed, float sigma, float step = 0) {
  Frame frame{.width = 160, .height = 80};
  std::mt19937 random(seed);
  std::normal_distribution<float> normal(0, sigma);
  for (int i = 0; i < 160 * 80; i++)
    frame.color.push_back(vec3(1 + normal(random) + (i % 160 < 80 ? step : 0)));
  return frame;
}
PicturePair pair_of(uint32_t seed, float sigma, float step = 0) {
  return {noisy(seed, sigma, step), noisy(seed + 1, sigma, step), 0};
}

TEST(PicturePair, KnowsItsOwnNoise) {
  EXPECT_NEAR(noise(pair_of(1, 0.25f)), 0.25, 0.01);
  // Differences that both pictures share are no noise.
  EXPECT_NEAR(noise(pair_of(3, 0.25f, 0.5f)), 0.25, 0.01);
}

TEST(PicturePair, NoiseAloneAgrees) {
  Agreement a = compare_pairs(pair_of(1, 0.2f), pair_of(3, 0.4f));
  EXPECT_LT(std::abs(a.relative_mean), 4 * a.relative_error);
  EXPECT_NEAR(a.relative_error, std::hypot(0.2, 0.4) / std::sqrt(2 * 160 * 80), 1e-4);
  EXPECT_NEAR(a.block_z, 1, 4 / std::sqrt(2 * 200.0));
  EXPECT_LT(std::abs(a.correlation), 4 * a.correlation_error);
}

TEST(PicturePair, FindsABrighterHalf) {
  Agreement a = compare_pairs(pair_of(1, 0.2f, 0.1f), pair_of(3, 0.2f));
  EXPECT_NEAR(a.relative_mean, 0.05, 4 * a.relative_error);
  EXPECT_GT(a.block_z, 2);
  EXPECT_GT(a.correlation, 0.5);
}

}  // namespace
}  // namespace wellspring::test
