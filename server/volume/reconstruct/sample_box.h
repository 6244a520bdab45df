// SPDX-License-Identifier: Apache-2.0
// Samples that lie somewhere in memory, and the place between them at which something is asked.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>

#include "base/layers.h"
#include "base/simd.h"

namespace wellspring::volume {

// Borrows a box of samples: a grid, or a brick in a pool of bricks. A sample `s` measures
// `scale * s + offset`. Places in a box are indices: sample (x, y, z) lies at (x, y, z). A place
// outside is moved to the nearest one inside; NaN counts as 0.
template <class Sample>
struct SampleBox {
  const Sample* samples = nullptr;  // sample (0, 0, 0)
  glm::ivec3 size{0};               // at least 1
  int row = 0, slice = 0;           // samples from (x, y, z) to (x, y + 1, z), and to (x, y, z + 1)
  float scale = 1, offset = 0;
  // Counts the samples that may be read from `samples` on; 2^31 - 1 at most. A pool's boxes may
  // all be read through the first: then `first`, below, says where each lane's box begins.
  int count = 0;
};

// Returns the box of samples that lie close, x fastest.
template <class Sample>
SampleBox<Sample> whole_box(const Sample* samples, glm::ivec3 size) {
  return {.samples = samples,
          .size = size,
          .row = size.x,
          .slice = size.x * size.y,
          .count = size.x * size.y * size.z};
}

// A place is this far, 0 to 1, from sample `at` to the next one; 0 if there is no next one.
template <class Real>
struct AxisPlace {
  int at;
  Real way;
};
template <class Real>
inline AxisPlace<Real> place_on_axis(Real position, int size) {
  const Real inside = std::min(position > 0 ? position : Real(0), Real(size - 1));
  const int at = std::min(int(inside), std::max(size - 2, 0));
  return {at, inside - Real(at)};
}

struct LanesPlace {
  LaneMask at;
  Lanes way;
};
inline LanesPlace place_on_axis(const Lanes& position, int size) {
  const Lanes inside = lanes_min(positive_lanes(position), all_lanes(float(size - 1)));
  const LaneMask whole = __builtin_convertvector(inside, LaneMask);
  const LaneMask last = LaneMask{} + std::max(size - 2, 0);
  const LaneMask at = whole < last ? whole : last;
  return {at, inside - __builtin_convertvector(at, Lanes)};
}

}  // namespace wellspring::volume
