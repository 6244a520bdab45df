// SPDX-License-Identifier: Apache-2.0
// The shapes of eight neighbouring blades.
#pragma once
#include "base/simd.h"
#include "lawn/lawn.h"
#include "lawn/wind.h"

namespace wellspring::lawn {

// Holds the joints of eight strips from root to tip; `length` is that of a segment, `free` the
// share that wind has in where they are: 0 while they lie, 1 where nothing has touched them.
struct BladeShapes {
  Lanes3 joint[joints];
  Lanes length{}, free = all_lanes(1);
};

// Returns how wind alone bends the blades from `first` on, a multiple of eight. Segments turn and
// keep their length.
BladeShapes eval_wind_shapes(const Lawn& lawn, int first, const WindNow& wind);

// Returns how far wind moves joints from where they are: metres aside for a push of 1, as far as
// that is linear, in the mean of all directions.
struct BladeSway {
  Lanes joint[joints];
};
BladeSway eval_sway(const Lawn& lawn, int first, const BladeShapes& shapes);

// Returns unit vectors; (0, 1, 0) for what has no length.
inline Lanes3 unit_lanes(const Lanes3& v) {
  const Lanes length2 = dot(v, v);
  const LaneMask has = length2 > 1e-20f;
  const Lanes scale = 1.0f / lanes_sqrt(has ? length2 : all_lanes(1));
  return choose(has, v * scale, all_lanes(vec3(0, 1, 0)));
}
inline Lanes3 cross(const Lanes3& a, const Lanes3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace wellspring::lawn
