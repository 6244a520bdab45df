// SPDX-License-Identifier: Apache-2.0
// Statistical judgement for tests: means with error bars, z-tests at a stated significance,
// chi-squared. Seeds are fixed, so a test that passes once passes always; the significance says how
// surprising a right program's result may be.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/rng.h"
#include "light/technique/technique.h"

namespace wellspring::test {

// Two-sided significance of every mean test: 1 in 10,000.
inline constexpr double significance_z = 3.89;

struct Mean {
  double sum = 0, squares = 0, count = 0;
  void add(double x) {
    sum += x;
    squares += x * x;
    count++;
  }
  double mean() const { return sum / count; }
  double error() const {  // standard error of the mean
    double variance = std::max(0.0, squares / count - mean() * mean());
    return std::sqrt(variance / (count - 1));
  }
};

// The mean is the expected value within its own error bars, and the bars are short enough to mean
// something.
inline void expect_mean(const Mean& m, double expected, const char* what,
                        double longest_bar = 0.02) {
  double slack = 5e-5 * std::abs(expected) + 1e-9;  // float rounding of noise-free estimates
  EXPECT_LE(std::abs(m.mean() - expected), significance_z * m.error() + slack)
      << what << ": mean " << m.mean() << " +- " << m.error() << ", expected " << expected;
  EXPECT_LE(m.error(), longest_bar * std::abs(expected) + slack) << what << ": too noisy to tell";
}

inline void expect_same_mean(const Mean& a, const Mean& b, const char* what) {
  double error = std::sqrt(a.error() * a.error() + b.error() * b.error());
  EXPECT_LE(std::abs(a.mean() - b.mean()), significance_z * error + 1e-6 * std::abs(a.mean()))
      << what << ": " << a.mean() << " +- " << a.error() << " against " << b.mean() << " +- "
      << b.error();
}

// Luminance of `count` samples of one ray.
inline Mean trace_mean(const char* technique, const World& world, const Lights& lights, Ray ray,
                       int count, TransportSettings settings = {}, uint64_t seed = 7) {
  std::vector<Request> requests(static_cast<size_t>(count));
  for (size_t i = 0; i < requests.size(); i++) {
    requests[i].ray = ray;
    requests[i].seed = sample_seed(seed, 0, 0, uint32_t(i));
  }
  std::vector<Sample> samples(requests.size());
  trace(*find_technique(technique), world, lights, settings, requests, samples);
  Mean mean;
  for (const Sample& s : samples) mean.add(double(luminance(s.radiance())));
  return mean;
}

inline Ray ray_towards(vec3 eye, vec3 target) {
  return Ray{.origin = eye, .direction = normalize(target - eye)};
}

// Upper bound of a chi-squared variable at significance 1e-4 (Wilson and Hilferty 1931).
inline double chi_squared_limit(double degrees) {
  double t = 2.0 / (9 * degrees);
  return degrees * std::pow(1 - t + 3.719 * std::sqrt(t), 3);
}

// Counts against expectations; bins that expect fewer than five are judged together.
inline void expect_chi_squared(const std::vector<double>& counts,
                               const std::vector<double>& expected, const char* what) {
  double statistic = 0, rare_count = 0, rare_expected = 0;
  int bins = 0;
  auto judge = [&](double count, double expect) {
    statistic += (count - expect) * (count - expect) / expect;
    bins++;
  };
  for (size_t i = 0; i < counts.size(); i++) {
    if (expected[i] >= 5) {
      judge(counts[i], expected[i]);
    } else {
      rare_count += counts[i];
      rare_expected += expected[i];
    }
  }
  if (rare_expected >= 5) judge(rare_count, rare_expected);
  else
    EXPECT_LE(rare_count, rare_expected + 5 * std::sqrt(rare_expected) + 5)
        << what << ": in rare bins";
  ASSERT_GT(bins, 1) << what;
  EXPECT_LE(statistic, chi_squared_limit(bins - 1)) << what << ": " << bins << " bins";
}

}  // namespace wellspring::test
