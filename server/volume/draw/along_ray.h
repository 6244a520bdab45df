// SPDX-License-Identifier: Apache-2.0
// Rays through a volume share this: cuts, places in samples, and the exponential.
#pragma once
#include <cmath>

#include "base/simd.h"
#include "volume/draw/shown_volume.h"

namespace wellspring::volume {

// A half-space that is kept: places p with dot(normal, p) >= offset, metres.
struct VolumeCut {
  vec3 normal{1, 0, 0};
  float offset = 0;
};

// Leads from metres to places in a level, in samples: `turn` times a place plus `shift`.
struct ToSamples {
  glm::mat3 turn{1};
  vec3 shift{0};

  ToSamples(const ShownVolume& volume, int level) {
    const glm::dmat4 inverse = glm::inverse(volume.to_metres);
    const double scale = std::ldexp(1.0, -level);
    turn = glm::mat3(glm::dmat3(inverse) * scale);
    shift = vec3((glm::dvec3(inverse[3]) + 0.5) * scale - 0.5);
  }
  Lanes3 way(const Lanes3& d) const {
    return {turn[0].x * d.x + turn[1].x * d.y + turn[2].x * d.z,
            turn[0].y * d.x + turn[1].y * d.y + turn[2].y * d.z,
            turn[0].z * d.x + turn[1].z * d.y + turn[2].z * d.z};
  }
  Lanes3 place(const Lanes3& p) const { return way(p) + all_lanes(shift); }
};

// Returns exp(-x) for x of 0 or more, with a relative error below 3e-6: a power of two times the
// first terms of the exponential series.
inline Lanes fade(const Lanes& x) {
  const Lanes power = lanes_min(x * -1.442695041f, Lanes{});
  const LaneMask whole = round_lanes(lanes_max(power, all_lanes(-126)));
  const Lanes rest =
      (lanes_max(power, all_lanes(-126)) - __builtin_convertvector(whole, Lanes)) * 0.693147181f;
  Lanes series = all_lanes(1 / 120.0f);
  series = series * rest + 1 / 24.0f;
  series = series * rest + 1 / 6.0f;
  series = series * rest + 0.5f;
  series = series * rest + 1.0f;
  series = series * rest + 1.0f;
  return series * lanes_as<Lanes>((whole + 127) << 23);
}

}  // namespace wellspring::volume
