// SPDX-License-Identifier: Apache-2.0
#include "volume/reconstruct/line_filter.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace wellspring::test {
namespace {

std::vector<double> line_samples(size_t count) {
  std::mt19937 random(5);
  std::vector<double> samples(count);
  for (double& sample : samples) sample = double(random()) / 2147483648.0 - 1;
  return samples;
}

TEST(LineFilter, MirrorsStandInTheLastSamples) {
  std::vector<int> found;
  for (int i = -6; i <= 9; i++) found.push_back(mirrored(i, 4));
  EXPECT_EQ(found, (std::vector<int>{0, 1, 2, 3, 2, 1, 0, 1, 2, 3, 2, 1, 0, 1, 2, 3}));
  EXPECT_EQ(mirrored(-3, 1), 0);
  EXPECT_EQ(mirrored(7, 2), 1);
  EXPECT_EQ(mirrored(std::numeric_limits<int>::min(), 2), 0);
}

TEST(LineFilter, ASplineOfInterpolatingCoefficientsMeetsTheSamples) {
  for (int length : {1, 2, 3, 4, 50}) {
    const std::vector<double> samples = line_samples(size_t(length));
    std::vector<double> c = samples;
    filter_axis(c, {length, 1, 1}, 0, LineFilter::interpolating);
    for (int i = 0; i < length; i++) {
      const double before = c[size_t(mirrored(i - 1, length))],
                   after = c[size_t(mirrored(i + 1, length))];
      EXPECT_NEAR((before + 4 * c[size_t(i)] + after) / 6, samples[size_t(i)], 1e-14) << length;
    }
  }
}

TEST(LineFilter, TapsAreThoseOfThePaper) {
  const glm::ivec3 size(9, 1, 1);
  auto response = [&](LineFilter filter) {
    std::vector<double> impulse(9);
    impulse[4] = 6;
    filter_axis(impulse, size, 0, filter);
    return std::vector<double>(impulse.begin() + 2, impulse.begin() + 7);
  };
  auto expect = [&](LineFilter filter, const std::vector<double>& wanted) {
    const std::vector<double> found = response(filter);
    for (size_t i = 0; i < wanted.size(); i++) EXPECT_NEAR(found[i], wanted[i], 1e-15) << i;
  };
  expect(LineFilter::quasi_interpolating, {0, -1, 8, -1, 0});
  expect(LineFilter::central_difference, {0, 3, 0, -3, 0});
  expect(LineFilter::wide_difference, {-1, 5, 0, -5, 1});
}

TEST(LineFilter, EachAxisIsFilteredLikeALine) {
  const glm::ivec3 size(19, 5, 7);
  const std::vector<double> samples = line_samples(19 * 5 * 7);
  const size_t strides[] = {1, 19, 19 * 5};
  for (int axis = 0; axis < 3; axis++) {
    std::vector<double> filtered = samples;
    filter_axis(filtered, size, axis, LineFilter::interpolating);
    for (size_t begin = 0; begin < samples.size(); begin++) {
      if (begin / strides[axis] % size_t(size[axis]) != 0) continue;
      std::vector<double> line;
      for (int i = 0; i < size[axis]; i++)
        line.push_back(samples[begin + size_t(i) * strides[axis]]);
      filter_axis(line, {size[axis], 1, 1}, 0, LineFilter::interpolating);
      for (int i = 0; i < size[axis]; i++)
        EXPECT_EQ(filtered[begin + size_t(i) * strides[axis]], line[size_t(i)]);
    }
  }
}

TEST(LineFilter, NothingBecomesInfinite) {
  constexpr float largest = std::numeric_limits<float>::max();
  for (LineFilter filter : {LineFilter::quasi_interpolating, LineFilter::interpolating,
                            LineFilter::central_difference, LineFilter::wide_difference}) {
    std::vector<float> values;
    for (int i = 0; i < 20; i++) values.push_back(i / 2 % 2 == 0 ? largest : -largest);
    filter_axis(values, {20, 1, 1}, 0, filter);
    for (float value : values) EXPECT_TRUE(std::isfinite(value));
  }
}

}  // namespace
}  // namespace wellspring::test
