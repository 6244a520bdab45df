// SPDX-License-Identifier: Apache-2.0
// What the samples of a view at rest say by themselves, and how much of a picture they become.
#include "picture/still/still_samples.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/rng.h"
#include "cache/packing.h"

namespace wellspring::test {
namespace {

constexpr int width = 93, height = 61, pixels = width * height;  // sizes that no square divides

// Half dark, half bright, with a step that a pixel-wide line follows.
vec3 truth_at(int x, int y) {
  if (x == 40) return vec3(0.9f, 0.8f, 0.1f);
  return x < 40 ? vec3(0.1f, 0.12f, 0.15f) : vec3(0.5f, 0.45f, 0.4f) + 0.002f * float(y);
}

struct Picture {
  Frame frame;
  StillImage still;
  StillSamples samples;
  std::vector<float> shares;
  std::vector<vec3> sums = std::vector<vec3>(pixels, vec3(0));
  int taken = 0;
  Picture() {
    frame.width = width, frame.height = height;
    for (int i = 0; i < pixels; i++) frame.color.push_back(truth_at(i % width, i / width));
    still.count.assign(pixels, 1);
    resize_samples(samples, pixels);
  }
  // Samples of the truth, exponentially distributed: a few bright ones make most of the light.
  void sample(int count, uint64_t seed) {
    Rng rng(mix64(seed));
    for (int n = 0; n < count; n++, taken++)
      for (int i = 0; i < pixels; i++) {
        float share = -std::log(1 - float(rng.next() >> 8) * 0x1p-24f);
        vec3 light = share * truth_at(i % width, i / width);
        sums[size_t(i)] += light;
        add_sample(samples, size_t(i), light, rng.next());
      }
  }
  double means_error() const {
    double sum = 0;
    for (int i = 0; i < pixels; i++) {
      vec3 d = sums[size_t(i)] / float(taken) - truth_at(i % width, i / width);
      sum += double(dot(d, d));
    }
    return std::sqrt(sum / (3 * pixels));
  }
  double error() const {
    double sum = 0;
    for (int i = 0; i < pixels; i++) {
      vec3 d = frame.color[size_t(i)] - truth_at(i % width, i / width);
      sum += double(dot(d, d));
    }
    return std::sqrt(sum / (3 * pixels));
  }
  void mix() { mix_in_means(samples, {width, height}, shares, frame.color); }
};

// Drawn without the line, and a tenth too bright.
void draw_wrongly(Picture& p) {
  for (int i = 0; i < pixels; i++) {
    int x = i % width;
    p.frame.color[size_t(i)] = 1.1f * truth_at(x == 40 ? 41 : x, i / width);
  }
}

TEST(MeanShare, WhatIsDrawnWrongBecomesTheMeanOfItsSamples) {
  double before = 1;
  for (int count : {16, 64, 250}) {
    Picture p;
    draw_wrongly(p);
    const double drawn = p.error();
    p.sample(count, uint64_t(count));
    p.mix();
    EXPECT_LT(p.error(), 0.9 * drawn) << count;
    EXPECT_LT(p.error(), 0.9 * p.means_error()) << count;
    EXPECT_LT(p.error(), before) << count;
    before = p.error();
  }
  EXPECT_LT(before, 0.03);
}

TEST(MeanShare, WhatIsRightStays) {
  for (int count : {1, 2, 4, 16, 64}) {
    Picture p;
    p.sample(count, 77 + uint64_t(count));
    p.mix();
    EXPECT_LT(p.error(), 0.45 * p.means_error()) << count;
  }
}

// Nobody knows how far first samples are off.
TEST(MeanShare, OfFewSamplesIsNothing) {
  Picture p;
  draw_wrongly(p);
  p.sample(4, 3);
  const std::vector<vec3> drawn = p.frame.color;
  p.mix();
  EXPECT_EQ(p.frame.color, drawn);
  p.sample(12, 4);
  p.mix();
  EXPECT_NE(p.frame.color, drawn);
}

// One sample far brighter than all others may be chance, however many the others are.
TEST(MeanShare, OfOneBrightSampleIsSmall) {
  for (int others : {0, 3, 15, 63}) {
    Picture p;
    p.sample(others, 5);
    const size_t at = size_t(30 * width + 20);
    p.sums[at] += vec3(4);
    add_sample(p.samples, at, vec3(4), 0x808080);
    const std::vector<vec3> drawn = p.frame.color;
    p.mix();
    EXPECT_LT(length(p.frame.color[at] - drawn[at]), 0.15f * 4.0f / float(others + 1)) << others;
  }
}

TEST(MeanShare, OfPixelsWithoutSamplesIsNothing) {
  Picture p;
  draw_wrongly(p);
  p.sample(64, 9);
  for (int i = 0; i < pixels; i++)
    if (i % width >= 30 && i % width < 50) p.samples.count[size_t(i)] = 0;
  const std::vector<vec3> drawn = p.frame.color;
  p.mix();
  int changed = 0;
  for (int i = 0; i < pixels; i++)
    if (p.samples.count[size_t(i)] == 0) EXPECT_EQ(p.frame.color[size_t(i)], drawn[size_t(i)]) << i;
    else changed += p.frame.color[size_t(i)] != drawn[size_t(i)];
  EXPECT_GT(changed, pixels / 2);
}

TEST(StillSamples, AreForgottenWhereThePictureBeginsAnew) {
  Picture p;
  p.sample(3, 1);
  p.still.count[5] = 0;
  invalidate_samples(p.still, p.samples);
  for (size_t i = 0; i < 10; i++) EXPECT_EQ(p.samples.count[i], i == 5 ? 0 : 3) << i;
}

// The deviation of an exponential distribution is its mean. The bounds are those of means over 61
// pixels of 200 samples each, four of their standard deviations (one in 16,000), and two
// thousandths for rounding.
TEST(StillSamples, MeansAndDeviationsAreThoseOfTheSamples) {
  Picture p;
  p.sample(200, 3);
  double mean = 0, deviation = 0;
  for (int y = 0; y < height; y++) {
    size_t i = size_t(y * width + 10);
    EXPECT_EQ(p.samples.count[i], 200);
    vec3 truth = truth_at(10, y);
    mean += double(unpack_rgb9e5(p.samples.mean[i]).x / truth.x) / height;
    deviation +=
        double(unpack_deviation(p.samples.deviation[i]) / std::sqrt(dot(truth, truth) / 3)) /
        height;
  }
  EXPECT_NEAR(mean, 1, 4 / std::sqrt(200.0 * height) + 0.002);
  // The deviation's own is sqrt(8 / 200) / 2, and it is 1 / 100 too small on average (half of its
  // square).
  EXPECT_NEAR(deviation, 0.99, 4 * 0.1 / std::sqrt(double(height)) + 0.002);
}

}  // namespace
}  // namespace wellspring::test
