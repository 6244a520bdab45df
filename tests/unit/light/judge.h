// SPDX-License-Identifier: Apache-2.0
// Judging a technique against a known answer: its error bars come from independent replicates
// (pictures of different seeds; samples of one seed are spread on purpose and say nothing of their
// own error), the verdict from Student's t-test at a stated significance that holds for a whole
// family of comparisons (Sidak 1967), and a test too noisy to notice a bias of a stated size fails
// as well: passing means something.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "base/rng.h"
#include "light/technique/technique.h"

namespace wellspring::test {

// A right technique is refuted by one family of comparisons in a thousand.
inline constexpr double family_significance = 1e-3;
// A technique that is wrong by this share is refuted with this probability.
inline constexpr double bias_to_find = 0.01, power_to_find_it = 0.99;
// Float arithmetic: bars are never taken as shorter than this share of the value.
inline constexpr double rounding = 1e-5;

struct Estimate {
  double mean = 0, error = 0;  // standard error of the mean
  int replicates = 0;
};

inline Estimate make_estimate(const std::vector<double>& replicates) {
  Estimate e;
  e.replicates = int(replicates.size());
  for (double x : replicates) e.mean += x / e.replicates;
  double squares = 0;
  for (double x : replicates) squares += (x - e.mean) * (x - e.mean);
  e.error = std::sqrt(squares / (double(e.replicates) * (e.replicates - 1)));
  return e;
}

struct Effort {
  int replicates = 64;
  int spp = 128;  // samples a pixel in each
  uint64_t seed = 1;
};

// Mean luminance of the picture in the view, by lights that the technique has prepared.
inline Estimate estimate_prepared(const Technique& technique, const World& world,
                                  const Lights& lights, const View& view,
                                  const TransportSettings& transport, const Effort& effort) {
  std::vector<double> replicates(size_t(effort.replicates));
  parallel_for(effort.replicates, [&](int i) {
    Frame frame = render_still(technique, world, lights, view,
                               {.spp = effort.spp,
                                .seed = mix64(effort.seed * 1000003 + uint64_t(i)),
                                .transport = transport});
    double sum = 0;
    for (vec3 c : frame.color) sum += double(luminance(c));
    replicates[size_t(i)] = sum / double(frame.color.size());
  });
  return make_estimate(replicates);
}
inline Estimate estimate_radiance(const Technique& technique, const World& world, Lights lights,
                                  const View& view, const TransportSettings& transport,
                                  const Effort& effort) {
  if (technique.prepare) technique.prepare(world, std::span(&view.position, 1), lights);
  return estimate_prepared(technique, world, lights, view, transport, effort);
}

// A picture so narrow that all of it is one ray; techniques that work in passes over a picture
// get a few pixels to spread over.
inline View view_along(Ray ray, const Technique& technique) {
  View view{.position = ray.origin, .forward = ray.direction};
  vec3 other = std::abs(ray.direction.y) < 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0);
  view.right = normalize(cross(view.forward, other));
  view.up = cross(view.right, view.forward);
  view.tan_half_fov = 1e-6f;
  view.width = view.height = technique.begin_pass || technique.finish_pass ? 6 : 1;
  return view;
}

struct Comparison {
  std::string what;
  Estimate estimate;
  double expected = 0, error = 0;  // standard error of the difference
  double degrees = 0;              // degrees of freedom
};

struct Verdict {
  double t = 0;
  double limit = 0;       // limit of |t|, at the family's significance
  double detectable = 0;  // share of the expected value that would be found
  bool refuted = false, weak = false;
};

// Comparisons that are judged together.
struct Family {
  std::vector<Comparison> comparisons;

  void add(const std::string& what, const Estimate& e, double expected) {
    comparisons.push_back({what, e, expected, e.error, double(e.replicates - 1)});
  }
  // Two estimates of the same thing (Welch's test).
  void add_same(const std::string& what, const Estimate& a, const Estimate& b) {
    double va = a.error * a.error, vb = b.error * b.error, sum = va + vb;
    double degrees = double(a.replicates + b.replicates - 2);
    if (sum > 0)
      degrees = sum * sum / (va * va / (a.replicates - 1) + vb * vb / (b.replicates - 1));
    comparisons.push_back({what, a, b.mean, std::sqrt(sum), degrees});
  }
};

Verdict judge(const Comparison& comparison, size_t family_size);

// `find`: share of the expected value that must be found; larger where only a rough check is meant.
void expect_family(const Family& family, double find = bias_to_find);

}  // namespace wellspring::test
