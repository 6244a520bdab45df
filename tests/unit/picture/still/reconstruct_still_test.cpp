// SPDX-License-Identifier: Apache-2.0
// Pictures at rest from few samples, and what they become of many. Needs the networks' weights.
#include "picture/still/reconstruct_still.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace wellspring::test {
namespace {

constexpr int width = 160, height = 96;

struct Rest {
  StillSamples samples;
  StillReconstruction work;
  Frame frame;
  Rest() {
    const size_t pixels = size_t(width) * size_t(height);
    resize_samples(samples, pixels);
    work.guides.albedo.assign(pixels, vec3(0.5f));
    work.guides.normal.assign(pixels, vec3(0, 0, 1));
    fit_frame(width, height, frame);
    std::fill(frame.color.begin(), frame.color.end(), vec3(0.3f));
  }
  // Samples of exponential noise around what `light` says, of the share of pixels.
  void sample(const std::function<float(size_t)>& light, int count, double share = 1) {
    std::mt19937 random(11);
    std::exponential_distribution<float> noise(1);
    std::uniform_real_distribution<double> chosen(0, 1);
    for (size_t i = 0; i < frame.color.size(); i++)
      if (chosen(random) < share)
        for (int k = 0; k < count; k++)
          add_sample(samples, i, vec3(light(i) * noise(random)), uint32_t(random()));
  }
  void reconstruct(Denoiser& denoiser) {
    begin_reconstruction(samples, frame, denoiser, work);
    while (denoiser.advance(1)) {}
    finish_reconstruction(samples, denoiser, work, frame);
  }
  double error(const std::function<float(size_t)>& light) const {
    double sum = 0;
    for (size_t i = 0; i < frame.color.size(); i++) {
      EXPECT_TRUE(is_finite(frame.color[i]));
      double apart = double(luminance(frame.color[i])) / double(light(i)) - 1;
      sum += apart * apart;
    }
    return std::sqrt(sum / double(frame.color.size()));
  }
};

float step(size_t i) { return i % width < width / 2 ? 0.2f : 0.6f; }
float fine_pattern(size_t i) { return (i % width / 2 + i / width / 2) % 2 ? 0.2f : 0.6f; }

class ReconstructStill : public testing::Test {
 protected:
  void SetUp() override {
    denoiser = load_denoiser(NetSize::small, problem, WELLSPRING_WEIGHTS_FOLDER);
    if (!denoiser) GTEST_SKIP() << problem;
  }
  std::string problem;
  std::unique_ptr<Denoiser> denoiser;
};

TEST_F(ReconstructStill, TwoSamplesAPixelComeNearTheReference) {
  Rest rest;
  rest.sample(step, 2);
  rest.reconstruct(*denoiser);
  EXPECT_LT(rest.error(step), 0.15);  // the two samples themselves: 0.7
}

TEST_F(ReconstructStill, PixelsWithoutSamplesAreNoHoles) {
  Rest rest;
  rest.sample(step, 1, 0.3);
  rest.reconstruct(*denoiser);
  EXPECT_LT(rest.error(step), 0.45);
}

TEST_F(ReconstructStill, WithoutASampleItIsThePictureDrawn) {
  Rest rest;
  rest.reconstruct(*denoiser);
  EXPECT_LT(rest.error([](size_t) { return 0.3f; }), 0.05);
}

// No guide tells of the pattern: the network takes it for noise as long as there is much of that.
TEST_F(ReconstructStill, BecomesTheMeanOfManySamples) {
  double before = 1;
  for (int count : {4, 32, 250}) {
    Rest rest;
    rest.sample(fine_pattern, count);
    rest.reconstruct(*denoiser);
    double error = rest.error(fine_pattern);
    EXPECT_LT(error, 0.75 * before) << count;
    EXPECT_LT(error, 1.4 / std::sqrt(double(count))) << count;
    before = error;
  }
  EXPECT_LT(before, 0.09);
}

TEST_F(ReconstructStill, CertainSamplesAreShownAsTheyAre) {
  Rest rest;
  for (size_t i = 0; i < rest.frame.color.size(); i++)
    for (int k = 0; k < 16; k++) add_sample(rest.samples, i, vec3(fine_pattern(i)), 0x808080u);
  rest.reconstruct(*denoiser);
  EXPECT_LT(rest.error(fine_pattern), 0.01);
}

// Bright samples are rare, so that most pixels' few samples agree on black by chance.
TEST_F(ReconstructStill, FewSamplesThatAgreeAreNotBelieved) {
  Rest rest;
  std::mt19937 random(3);
  for (size_t i = 0; i < rest.frame.color.size(); i++)
    for (int k = 0; k < int(random() % 4); k++)
      add_sample(rest.samples, i, vec3(random() % 8 == 0 ? 2.4f : 0.0f), uint32_t(random()));
  rest.reconstruct(*denoiser);
  EXPECT_LT(rest.error([](size_t) { return 0.3f; }), 0.5);  // the means themselves: 2 and more
}

TEST_F(ReconstructStill, LivesThroughLightOfAnyStrength) {
  Rest rest;
  for (size_t i = 0; i < rest.frame.color.size(); i++)
    add_sample(rest.samples, i, vec3(i % 13 == 0 ? 5e4f : 0.0f), 0);
  rest.reconstruct(*denoiser);
  for (vec3 c : rest.frame.color) ASSERT_TRUE(is_finite(c) && c.x >= 0);
}

}  // namespace
}  // namespace wellspring::test
