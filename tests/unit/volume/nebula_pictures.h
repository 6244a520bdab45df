// SPDX-License-Identifier: Apache-2.0
// Nebulae whose light is known.
#pragma once
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "image/image.h"
#include "volume/nebula/rings.h"

namespace wellspring::test {

inline constexpr double degree = glm::pi<double>() / 180;

// Returns the light of two lobes and a core at a radius and a height, both in parts of the grid's.
inline double lobes_and_core(double r, double z) {
  const auto ball = [&](double middle, double r_size, double z_size) {
    const double a = r / r_size, b = (z - middle) / z_size;
    return std::exp(-(a * a + b * b));
  };
  return ball(0.45, 0.3, 0.22) + ball(-0.45, 0.3, 0.22) + 2 * ball(0, 0.12, 0.12);
}

// Returns a map of that light, a channel a third as bright as the one before.
inline RingMap lobes_map(RingGrid grid) {
  RingMap map{grid, std::vector<ColorLanes>(size_t(grid.count()))};
  for (int m = 0; m < grid.axial; ++m)
    for (int k = 0; k < grid.radial; ++k) {
      const double light = lobes_and_core((k + 0.5) / grid.radial, 2 * (m + 0.5) / grid.axial - 1);
      map.light[size_t(grid.index(k, m))] = ColorLanes{light, light / 3, light / 9, 0};
    }
  return map;
}

// Returns rays through the pixels of a square picture of `side` pixels that is 2 `half` wide.
inline std::vector<glm::dvec2> square_rays(int side, double half) {
  std::vector<glm::dvec2> rays;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      rays.push_back(half * (2.0 * glm::dvec2(x + 0.5, y + 0.5) / double(side) - 1.0));
  return rays;
}

// Returns the distance between maps by the norm of the first.
inline double map_error(std::span<const ColorLanes> wanted, std::span<const ColorLanes> found) {
  double apart = 0, whole = 0;
  for (size_t i = 0; i < wanted.size(); ++i) {
    const double difference = wanted[i][0] - found[i][0];
    apart += difference * difference, whole += wanted[i][0] * wanted[i][0];
  }
  return std::sqrt(apart / whole);
}

// Draws an ellipse of soft light, axes in pixels, the long one at an angle counter-clockwise.
inline image::LinearImage soft_ellipse(int width, int height, double angle, double length,
                                       double breadth) {
  image::LinearImage picture{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double dx = x + 0.5 - 0.5 * width, dy = 0.5 * height - y - 0.5;
      const double u = (dx * std::cos(angle) + dy * std::sin(angle)) / length,
                   v = (dy * std::cos(angle) - dx * std::sin(angle)) / breadth;
      const float light = float(std::exp(-(u * u + v * v)));
      picture.color.push_back({light, 0.6f * light, 0.3f * light});
    }
  return picture;
}

}  // namespace wellspring::test
