// SPDX-License-Identifier: Apache-2.0
// Splines are of the orders that the paper proves, and its figure 4 comes out as numbers.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "judge/marschner_lobb.h"
#include "volume/reconstruct/spline.h"

namespace wellspring::test {
namespace {

struct SplineErrors {
  double value = 0, gradient = 0;
};
double spline_order(double coarse, double fine) { return std::log2(coarse / fine); }

// Samples sin x + 0.3 cos(2.3 x + 0.7) over [0, 4] and looks where borders are far.
SplineErrors errors_on_line(GradientScheme scheme, int intervals) {
  const double step = 4.0 / intervals;
  auto wave = [](double x) { return std::sin(x) + 0.3 * std::cos(2.3 * x + 0.7); };
  auto slope = [](double x) { return std::cos(x) - 0.69 * std::sin(2.3 * x + 0.7); };
  std::vector<double> samples;
  for (int i = 0; i <= intervals; i++) samples.push_back(wave(i * step));
  const auto spline = make_spline<double>(samples, {intervals + 1, 1, 1}, scheme);
  SplineErrors most;
  for (int i = 0; i < 3000; i++) {
    const double x = 1.2 + 1.6 * i / 3000;
    const ValueGradient<double> found = gradient_at(spline, {x / step, 0, 0});
    most.value = std::max(most.value, std::abs(found.value - wave(x)));
    most.gradient = std::max(most.gradient, std::abs(found.gradient.x / step - slope(x)));
  }
  return most;
}

struct SchemeOrders {
  GradientScheme scheme;
  double value, gradient;
};

TEST(SplineOrder, ErrorsFallByThePapersOrders) {
  for (const SchemeOrders& wanted :
       {SchemeOrders{GradientScheme::central, 2, 2}, SchemeOrders{GradientScheme::wide, 2, 4},
        SchemeOrders{GradientScheme::analytic, 2, 2},
        SchemeOrders{GradientScheme::prefiltered, 4, 3},
        SchemeOrders{GradientScheme::wide_across, 4, 4},
        SchemeOrders{GradientScheme::interpolating, 4, 3}}) {
    SplineErrors coarse = errors_on_line(wanted.scheme, 80);
    for (int intervals : {160, 320}) {
      const SplineErrors fine = errors_on_line(wanted.scheme, intervals);
      EXPECT_NEAR(spline_order(coarse.value, fine.value), wanted.value, 0.1) << int(wanted.scheme);
      EXPECT_NEAR(spline_order(coarse.gradient, fine.gradient), wanted.gradient, 0.1)
          << int(wanted.scheme);
      coarse = fine;
    }
  }
}

TEST(SplineOrder, ErrorsAreAsSmallAsIsKnown) {
  auto expect = [](double error, double known) { EXPECT_NEAR(error / known, 1, 0.08); };
  expect(errors_on_line(GradientScheme::central, 320).value, 5.92e-5);
  expect(errors_on_line(GradientScheme::central, 320).gradient, 1.82e-4);
  expect(errors_on_line(GradientScheme::wide, 320).gradient, 4.27e-8);
  expect(errors_on_line(GradientScheme::analytic, 320).gradient, 9.12e-5);
  expect(errors_on_line(GradientScheme::prefiltered, 320).value, 6.7e-9);
  expect(errors_on_line(GradientScheme::prefiltered, 320).gradient, 1.43e-7);
}

// The same of sin(1.1 x + 0.8 y + 0.6 z) over [0, 2]^3.
double gradient_error_in_space(GradientScheme scheme, int intervals) {
  const glm::dvec3 wave(1.1, 0.8, 0.6);
  const double step = 2.0 / intervals;
  const int size = intervals + 1;
  std::vector<double> samples;
  for (int z = 0; z < size; z++)
    for (int y = 0; y < size; y++)
      for (int x = 0; x < size; x++)
        samples.push_back(std::sin(glm::dot(wave, glm::dvec3(x, y, z) * step)));
  const auto spline = make_spline<double>(samples, glm::ivec3(size), scheme);
  double most = 0;
  for (int i = 0; i < 1000; i++) {
    const glm::dvec3 at = 0.8 + 0.4 * glm::dvec3(i % 10, i / 10 % 10, i / 100) / 9.7;
    const glm::dvec3 found = gradient_at(spline, at / step).gradient / step;
    most = std::max(most, glm::length(found - wave * std::cos(glm::dot(wave, at))));
  }
  return most;
}

TEST(SplineOrder, InSpaceTheWideDifferenceNeedsThePrefilterAcross) {
  auto order = [](GradientScheme scheme) {
    return spline_order(gradient_error_in_space(scheme, 32), gradient_error_in_space(scheme, 64));
  };
  EXPECT_NEAR(order(GradientScheme::central), 2, 0.1);
  EXPECT_NEAR(order(GradientScheme::wide), 2, 0.1);
  EXPECT_NEAR(order(GradientScheme::analytic), 2, 0.1);
  EXPECT_GT(order(GradientScheme::prefiltered), 2.9);
  EXPECT_NEAR(order(GradientScheme::wide_across), 4, 0.1);
}

TEST(SplineOrder, GradientsOfMarschnerAndLobbsSignalAreAsGoodAsKnown) {
  const std::vector<double> samples = sample_marschner_lobb<double>(60);
  const std::vector<glm::dvec3> points = marschner_lobb_surface(5000);
  auto mean_angle = [&](GradientScheme scheme) {
    const auto spline = make_spline<double>(samples, glm::ivec3(60), scheme);
    double sum = 0;
    for (const glm::dvec3& point : points)
      sum += degrees_between(gradient_at(spline, (point + 1.0) * 29.5).gradient,
                             marschner_lobb_gradient(point));
    return sum / double(points.size());
  };
  EXPECT_NEAR(mean_angle(GradientScheme::central), 15.5, 0.2);
  EXPECT_NEAR(mean_angle(GradientScheme::wide), 7.05, 0.2);
  EXPECT_NEAR(mean_angle(GradientScheme::analytic), 7.74, 0.2);
  EXPECT_NEAR(mean_angle(GradientScheme::prefiltered), 3.08, 0.2);
  EXPECT_LT(mean_angle(GradientScheme::wide_across), 6.8);
  EXPECT_LT(mean_angle(GradientScheme::interpolating), 2.5);
}

TEST(SplineOrder, PolynomialsAreReconstructedExactly) {
  // Up to which powers along one axis, with straight lines along the others.
  struct Powers {
    GradientScheme scheme;
    int value, gradient;
  };
  const int size = 60;
  const double middle = 29.5;
  for (const Powers& exact :
       {Powers{GradientScheme::central, 1, 2}, Powers{GradientScheme::wide, 1, 4},
        Powers{GradientScheme::analytic, 1, 2}, Powers{GradientScheme::prefiltered, 3, 3},
        Powers{GradientScheme::wide_across, 3, 4}, Powers{GradientScheme::interpolating, 3, 3}})
    for (int axis = 0; axis < 3; axis++)
      for (int power = 0; power <= 5; power++) {
        glm::ivec3 extent(3);
        extent[axis] = size;
        const int other = (axis + 1) % 3;
        auto curve = [&](glm::dvec3 at) {
          return std::pow((at[axis] - middle) / 8, power) * (2 + 0.3 * at[other]);
        };
        auto slope = [&](glm::dvec3 at) {
          return power == 0 ? 0.0
                            : power * std::pow((at[axis] - middle) / 8, power - 1) / 8 *
                                  (2 + 0.3 * at[other]);
        };
        extent[other] = size;
        std::vector<double> samples;
        for (int z = 0; z < extent.z; z++)
          for (int y = 0; y < extent.y; y++)
            for (int x = 0; x < extent.x; x++) samples.push_back(curve({x, y, z}));
        const auto spline = make_spline<double>(samples, extent, exact.scheme);
        double value = 0, gradient = 0;
        for (int i = 0; i < 50; i++) {
          glm::dvec3 at(1);
          at[axis] = 25 + 0.2 * i, at[other] = 30.4;
          const ValueGradient<double> found = gradient_at(spline, at);
          value = std::max(value, std::abs(found.value - curve(at)));
          gradient = std::max(gradient, std::abs(found.gradient[axis] - slope(at)));
        }
        EXPECT_EQ(value < 1e-12, power <= exact.value) << int(exact.scheme) << ' ' << power;
        EXPECT_EQ(gradient < 1e-12, power <= exact.gradient) << int(exact.scheme) << ' ' << power;
      }
}

}  // namespace
}  // namespace wellspring::test
