// SPDX-License-Identifier: Apache-2.0
#include "volume/reconstruct/spline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "volume/reconstruct/line_filter.h"

namespace wellspring::test {
namespace {

constexpr GradientScheme all_schemes[] = {
    GradientScheme::central,     GradientScheme::wide,        GradientScheme::analytic,
    GradientScheme::prefiltered, GradientScheme::wide_across, GradientScheme::interpolating};

template <class Real>
std::vector<Real> spline_noise(glm::ivec3 size) {
  std::mt19937 random(9);
  std::vector<Real> samples(size_t(size.x) * size_t(size.y) * size_t(size.z));
  for (Real& sample : samples) sample = Real(double(random()) / 2147483648.0 - 1);
  return samples;
}

double spline_difference(const ValueGradient<double>& a, const ValueGradient<double>& b) {
  return std::max(std::abs(a.value - b.value), glm::length(a.gradient - b.gradient));
}

TEST(Spline, BordersAreMirrors) {
  const glm::ivec3 size(5, 4, 2);
  const int beyond = 24;
  const glm::ivec3 large = size + 2 * beyond;
  const std::vector<double> samples = spline_noise<double>(size);
  std::vector<double> mirrors;
  for (int z = 0; z < large.z; z++)
    for (int y = 0; y < large.y; y++)
      for (int x = 0; x < large.x; x++)
        mirrors.push_back(samples[size_t(
            (mirrored(z - beyond, size.z) * size.y + mirrored(y - beyond, size.y)) * size.x +
            mirrored(x - beyond, size.x))]);
  for (GradientScheme scheme : all_schemes) {
    const auto spline = make_spline<double>(samples, size, scheme);
    const auto reference = make_spline<double>(mirrors, large, scheme);
    for (int i = 0; i < 125; i++) {
      const glm::dvec3 at = glm::dvec3(size - 1) * glm::dvec3(i % 5, i / 5 % 5, i / 25) / 4.0;
      EXPECT_LT(
          spline_difference(gradient_at(spline, at), gradient_at(reference, at + double(beyond))),
          1e-12)
          << int(scheme) << ' ' << i;
    }
  }
}

TEST(Spline, InterpolatingOnesMeetAllSamplesAlsoAtBorders) {
  const glm::ivec3 size(6, 3, 5);
  const std::vector<double> samples = spline_noise<double>(size);
  const auto spline = make_spline<double>(samples, size, GradientScheme::interpolating);
  for (int i = 0; i < 90; i++)
    EXPECT_NEAR(value_at(spline, glm::dvec3(i % 6, i / 6 % 3, i / 18)), samples[size_t(i)], 1e-13);
}

TEST(Spline, PlacesOutsideAreMovedToTheBorder) {
  const glm::ivec3 size(5, 6, 7);
  for (GradientScheme scheme : all_schemes) {
    const auto spline = make_spline<double>(spline_noise<double>(size), size, scheme);
    const double far = std::numeric_limits<double>::infinity();
    const auto at_border = gradient_at(spline, glm::dvec3(0, 5, 2.5));
    EXPECT_EQ(spline_difference(gradient_at(spline, glm::dvec3(-far, 1e9, 2.5)), at_border), 0);
    EXPECT_EQ(spline_difference(gradient_at(spline, glm::dvec3(std::nan(""), 5, 2.5)), at_border),
              0);
    EXPECT_NEAR(at_border.gradient.x, 0, 1e-14);
    EXPECT_NEAR(at_border.gradient.y, 0, 1e-14);
  }
}

TEST(Spline, OneSampleIsTheSameEverywhere) {
  for (GradientScheme scheme : all_schemes) {
    Grid grid({1, 1, 1});
    grid.at(0, 0, 0) = 7;
    const auto found = gradient_at(make_spline(grid, scheme), glm::vec3(0.5f, -3, 9));
    EXPECT_NEAR(found.value, 7, 1e-5);
    EXPECT_NEAR(glm::length(found.gradient), 0, 1e-5);
  }
}

TEST(Spline, AThinGridIsALine) {
  const std::vector<double> samples = spline_noise<double>({1, 1, 4000});
  for (GradientScheme scheme : all_schemes) {
    const auto deep = make_spline<double>(samples, {1, 1, 4000}, scheme);
    const auto line = make_spline<double>(samples, {4000, 1, 1}, scheme);
    for (double at : {0.0, 0.3, 1999.5, 3998.9, 3999.0}) {
      const auto found = gradient_at(deep, glm::dvec3(0, 0, at)),
                 wanted = gradient_at(line, glm::dvec3(at, 0, 0));
      EXPECT_NEAR(found.value, wanted.value, 1e-13);
      EXPECT_NEAR(found.gradient.z, wanted.gradient.x, 1e-13);
      EXPECT_NEAR(found.gradient.x, 0, 1e-13);
    }
  }
}

TEST(Spline, AConstantStaysOne) {
  for (GradientScheme scheme : all_schemes) {
    const std::vector<double> samples(9 * 8 * 7, 37.25);
    const auto spline = make_spline<double>(samples, {9, 8, 7}, scheme);
    const auto found = gradient_at(spline, glm::dvec3(0.3, 4.7, 5.9));
    EXPECT_NEAR(found.value, 37.25, 1e-13);
    EXPECT_NEAR(glm::length(found.gradient), 0, 1e-13);
  }
}

TEST(Spline, HugeValuesStayFinite) {
  Grid grid({8, 8, 8});
  for (int i = 0; i < 512; i++)
    grid.values[size_t(i)] = (i + i / 8 + i / 64) % 2 == 0 ? 1e30f : -1e30f;
  for (GradientScheme scheme : all_schemes) {
    const Spline<float> spline = make_spline(grid, scheme);
    for (float at : {0.0f, 2.2f, 3.5f, 7.0f}) {
      const LanesGradient found = gradient_at(spline, all_lanes(vec3(at, 3.3f, 5 - at / 2)));
      EXPECT_TRUE(std::isfinite(found.value[0]));
      EXPECT_TRUE(is_finite(found.gradient.at(0)));
    }
  }
}

TEST(Spline, EightPlacesAtATimeAreAsOne) {
  std::mt19937 random(3);
  auto next = [&](float low, float high) {
    return low + (high - low) * float(random()) / 4294967296.0f;
  };
  for (glm::ivec3 size : {glm::ivec3(9, 8, 7), glm::ivec3(1, 2, 3), glm::ivec3(1, 1, 40)})
    for (GradientScheme scheme : all_schemes) {
      const std::vector<float> samples = spline_noise<float>(size);
      const auto spline = make_spline<float>(samples, size, scheme);
      for (int i = 0; i < 200; i++) {
        Lanes3 places;
        for (int l = 0; l < lane_count; l++)
          places.set(l, vec3(next(-2, 11), next(-2, 10), next(-2, float(size.z) + 2)));
        const Lanes value = value_at(spline, places);
        const LanesGradient both = gradient_at(spline, places);
        for (int l = 0; l < lane_count; l++) {
          const auto wanted = gradient_at(spline, places.at(l));
          EXPECT_NEAR(value[l], wanted.value, 2e-6f);
          EXPECT_NEAR(both.value[l], wanted.value, 2e-6f);
          EXPECT_LT(glm::length(both.gradient.at(l) - wanted.gradient), 4e-6f);
        }
      }
    }
}

TEST(Spline, CoefficientsOfBricksAreReadWhereTheyLie) {
  const glm::ivec3 brick(6, 6, 6);
  const int each = 216;
  std::vector<float> pool = spline_noise<float>({6, 6, 12});
  SampleBox<float> box = whole_box(pool.data(), brick);
  const int inner = 1 + box.row + box.slice;
  box.samples += inner, box.size = glm::ivec3(4), box.scale = 2, box.offset = 5;
  const Lanes3 places = all_lanes(vec3(1.25f, 3, 0.5f));
  const LanesGradient found = spline_gradient(box, places, LaneMask{0, each});
  for (int lane = 0; lane < 2; lane++) {
    box.samples = pool.data() + inner + lane * each;
    const LanesGradient wanted = spline_gradient(box, places);
    EXPECT_EQ(found.value[lane], wanted.value[0]);
    EXPECT_EQ(found.gradient.at(lane), wanted.gradient.at(0));
    box.scale = 1, box.offset = 0;
    EXPECT_NEAR(spline_value(box, places)[0] * 2 + 5, wanted.value[0], 1e-5f);
    EXPECT_NEAR(spline_gradient(box, places).gradient.y[0] * 2, wanted.gradient.y[0], 1e-6f);
    box.scale = 2, box.offset = 5;
  }
}

TEST(Spline, GridsThatAreNoneAreRefused) {
  const std::vector<float> samples(8);
  auto make = [&](glm::ivec3 size) {
    make_spline<float>(samples, size, GradientScheme::prefiltered);
  };
  EXPECT_NO_THROW(make({2, 2, 2}));
  EXPECT_THROW(make({2, 2, 1}), std::invalid_argument);
  EXPECT_THROW(make({-2, -2, 2}), std::invalid_argument);
  EXPECT_THROW(make({3, 1, 2}), std::invalid_argument);
  EXPECT_THROW(make_spline(Grid(), GradientScheme::central), std::invalid_argument);
}

}  // namespace
}  // namespace wellspring::test
