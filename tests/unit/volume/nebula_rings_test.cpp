// SPDX-License-Identifier: Apache-2.0
#include "volume/nebula/rings.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/load_error.h"
#include "unit/volume/nebula_pictures.h"
#include "volume/nebula/ring_sweep.h"

namespace wellspring::test {
namespace {

// Returns the sum of a system's only row.
double chord_of(const RingGrid& grid, double tilt, glm::dvec2 ray) {
  const std::vector<ColorLanes> ones(size_t(grid.count()), ColorLanes{1, 1, 1, 0});
  return gather_rays(make_ring_system(grid, tilt, std::vector{ray}), ones)[0][0];
}

TEST(NebulaRings, LengthsOfARaySumToItsChord) {
  // So long a cylinder is not cut by its ends.
  const RingGrid grid{30, 400, 30, 200};
  for (const double tilt : {0.0, 1e-12, 0.01, 0.3, 35.0, 45.0, 60.0, -45.0, 75.0})
    for (const double beside : {0.0, 0.5, -3.0, 17.3, 29.0, 29.999})
      for (const double along : {0.0, 0.49, -7.0}) {
        const double chord = 2 * std::sqrt(30 * 30 - beside * beside) / std::cos(tilt * degree);
        EXPECT_NEAR(chord_of(grid, tilt * degree, {along, beside}), chord, 1e-6 * chord)
            << tilt << " " << beside << " " << along;
      }
  EXPECT_EQ(chord_of(grid, 0.5, {0, 30}), 0);
  EXPECT_EQ(chord_of(grid, 0, {200.5, 0}), 0);
}

TEST(NebulaRings, ARaysLengthInEachRingIsThatOfSmallSteps) {
  const RingGrid grid{7, 9, 14, 12};
  const double tilt = 40 * degree;
  const glm::dvec2 ray(3.3, -4.1);
  std::vector<double> steps(size_t(grid.count()));
  const double step = 1e-3;
  for (double t = -40; t < 40; t += step) {
    const double height = ray.x * std::cos(tilt) + t * std::sin(tilt),
                 across = t * std::cos(tilt) - ray.x * std::sin(tilt);
    const int k = int(std::hypot(ray.y, across) / grid.thickness()),
              m = int(std::floor((height + grid.half_length) / grid.slab()));
    if (k < grid.radial && m >= 0 && m < grid.axial) steps[size_t(grid.index(k, m))] += step;
  }
  const RingSystem system = make_ring_system(grid, tilt, std::vector{ray});
  std::vector<double> lengths(size_t(grid.count()));
  const RingRows& rows = system.pieces[0];
  for (size_t i = 0; i < rows.length.size(); ++i) lengths[rows.ring[i]] += double(rows.length[i]);
  for (size_t i = 0; i < lengths.size(); ++i) EXPECT_NEAR(lengths[i], steps[i], 0.005) << i;
}

TEST(NebulaRings, ABallOfEvenLightLooksAsAbelsIntegralSays) {
  const double radius = 40, light = 0.7;
  const RingGrid grid{160, 320, 42, 42};
  RingMap map{grid, std::vector<ColorLanes>(size_t(grid.count()))};
  for (int m = 0; m < grid.axial; ++m)
    for (int k = 0; k < grid.radial; ++k) {
      const double r = (k + 0.5) * grid.thickness(), z = (m + 0.5) * grid.slab() - 42;
      if (std::hypot(r, z) < radius)
        map.light[size_t(grid.index(k, m))] = ColorLanes{light, light, light, 0};
    }
  const std::vector<glm::dvec2> rays{{0, 0}, {10.2, 0}, {0.1, 20}, {-15, 25}, {30, -10}};
  for (const double tilt : {0.0, 30.0, 60.0}) {
    const auto seen = gather_rays(make_ring_system(grid, tilt * degree, rays), map.light);
    for (size_t i = 0; i < rays.size(); ++i) {
      const double beside = glm::length(rays[i]);
      const double abel = 2 * light * std::sqrt(radius * radius - beside * beside);
      EXPECT_NEAR(seen[i][0], abel, 0.01 * abel) << tilt << " ray " << i;
    }
  }
}

TEST(NebulaRings, ATiltToTheVisitorLooksLikeOneAway) {
  const RingMap map = lobes_map({20, 30, 10, 15});
  const auto rays = square_rays(20, 12);
  const auto forward = gather_rays(make_ring_system(map.grid, 0.6, rays), map.light),
             backward = gather_rays(make_ring_system(map.grid, -0.6, rays), map.light);
  for (size_t i = 0; i < rays.size(); ++i) EXPECT_EQ(forward[i][0], backward[i][0]);
}

TEST(NebulaRings, GridsAndTiltsThatMakeNoSenseAreRefused) {
  const std::vector<glm::dvec2> rays{{0, 0}};
  EXPECT_THROW(make_ring_system({0, 10, 1, 1}, 0, rays), LoadError);
  EXPECT_THROW(make_ring_system({1000, 1000, 1, 1}, 0, rays), LoadError);
  EXPECT_THROW(make_ring_system({10, 10, 0, 1}, 0, rays), LoadError);
  EXPECT_THROW(make_ring_system({10, 10, 1, 1}, 1.5, rays), LoadError);
  EXPECT_THROW(make_ring_system({10, 10, 1, 1}, std::nan(""), rays), LoadError);
  EXPECT_EQ(make_ring_system({10, 10, 1, 1}, 0, {}).entries(), 0u);
}

}  // namespace
}  // namespace wellspring::test
