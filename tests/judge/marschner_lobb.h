// SPDX-License-Identifier: Apache-2.0
// The signal by which reconstructions are judged (Marschner and Lobb, An Evaluation of
// Reconstruction Filters for Volume Rendering, 1994): waves that 40^3 samples over [-1, 1]^3 just
// hold.
#pragma once
#include <cmath>
#include <glm/glm.hpp>
#include <random>
#include <vector>

namespace wellspring::test {

constexpr double ripple_frequency = 6, ripple_height = 0.25;
constexpr double ripple_pi = 3.14159265358979323846;

inline double ripple_phase(double radius) {
  return 2 * ripple_pi * ripple_frequency * std::cos(ripple_pi * radius / 2);
}

inline double marschner_lobb(glm::dvec3 at) {
  const double ripple = std::cos(ripple_phase(std::hypot(at.x, at.y)));
  return (1 - std::sin(ripple_pi * at.z / 2) + ripple_height * (1 + ripple)) /
         (2 * (1 + ripple_height));
}

inline glm::dvec3 marschner_lobb_gradient(glm::dvec3 at) {
  const double radius = std::max(std::hypot(at.x, at.y), 1e-12);
  const double slope = ripple_height * std::sin(ripple_phase(radius)) * ripple_pi * ripple_pi *
                       ripple_frequency * std::sin(ripple_pi * radius / 2);
  return glm::dvec3(slope * at.x / radius, slope * at.y / radius,
                    -ripple_pi / 2 * std::cos(ripple_pi * at.z / 2)) /
         (2 * (1 + ripple_height));
}

// Returns samples, x fastest, whose first and last lie at -1 and 1 along each axis.
template <class Real>
std::vector<Real> sample_marschner_lobb(int size) {
  std::vector<Real> samples;
  for (int z = 0; z < size; z++)
    for (int y = 0; y < size; y++)
      for (int x = 0; x < size; x++)
        samples.push_back(
            Real(marschner_lobb(glm::dvec3(x, y, z) * (2.0 / (size - 1)) - glm::dvec3(1))));
  return samples;
}

// Returns random points on the surface where the signal is 0.5, with |x| and |y| below 0.9.
inline std::vector<glm::dvec3> marschner_lobb_surface(int count) {
  std::mt19937 random(60);
  auto next = [&] { return 1.8 * double(random()) / 4294967296.0 - 0.9; };
  std::vector<glm::dvec3> points;
  for (int i = 0; i < count; i++) {
    const double x = next(), y = next();
    const double ripple = std::cos(ripple_phase(std::hypot(x, y)));
    points.emplace_back(x, y, 2 / ripple_pi * std::asin(ripple_height * ripple));
  }
  return points;
}

inline double degrees_between(glm::dvec3 a, glm::dvec3 b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180 / ripple_pi;
}

}  // namespace wellspring::test
