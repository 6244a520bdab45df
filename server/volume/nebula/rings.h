// SPDX-License-Identifier: Apache-2.0
// Rings of a solid of revolution, and how long rays are in each (Wenger and others, sections 3 and
// 4.1, equation 1). Rays are parallel; lengths are in the unit of the grid, mostly pixels.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "base/layers.h"

namespace wellspring::volume {

// Holds red, green and blue in the first three lanes; the fourth stays 0.
using ColorLanes = double __attribute__((vector_size(32)));

// A cylinder round the axis, cut into rings. Ring (k, m) lies between the radii k and k + 1 times
// radius / radial, and in slab m of `axial` slabs from -half_length to half_length.
struct RingGrid {
  int radial = 60, axial = 120;
  double radius = 1, half_length = 1;

  int count() const { return radial * axial; }
  int index(int k, int m) const { return m * radial + k; }
  double thickness() const { return radius / radial; }
  double slab() const { return 2 * half_length / axial; }
};
inline constexpr int most_rings = 65536;
inline constexpr double most_tilt = 1.309;  // radians, 75 degrees: beyond, depth means little

// The light of each ring, per unit of length.
struct RingMap {
  RingGrid grid;
  std::vector<ColorLanes> light;
};

// Rows of the sparse matrix, one after the other. The lengths of row i are those from begin[i] to
// begin[i + 1].
struct RingRows {
  int first_ray = 0;
  std::vector<uint32_t> begin;
  std::vector<uint16_t> ring;
  std::vector<float> length;
};

// The matrix A of equation 1, a row for each ray, in pieces of neighbouring rows. The pieces do not
// depend on the number of cores, so that sums come out the same on all machines.
struct RingSystem {
  RingGrid grid;
  int rays = 0;
  std::vector<RingRows> pieces;

  size_t entries() const;
};

// Builds the matrix. rays: where they pass in the picture, as (along, beside) the projected axis;
// tilt: of the axis out of the picture, radians, at most most_tilt either way. Its sign changes
// nothing: a solid of revolution that leans to the visitor looks like one that leans away.
// Throws LoadError if the grid has no rings, more than most_rings, or the tilt is too large.
RingSystem make_ring_system(const RingGrid& grid, double tilt, std::span<const glm::dvec2> rays);

}  // namespace wellspring::volume
