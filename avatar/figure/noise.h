// SPDX-License-Identifier: Apache-2.0
// Makes smooth noise over time: a function of (channel, time) alone, so it cannot drift. It is
// gradient noise in one dimension (Perlin 1985, with the quintic fade of Perlin 2002).
#pragma once
#include <cmath>

#include "base/rng.h"

namespace wellspring::avatar {

// Returns about -1..1 with mean 0; changes about once a second. `time` is in seconds times the
// wanted frequency.
inline float smooth_noise(uint32_t channel, double time) {
  double cell = std::floor(time);
  float t = float(time - cell);
  auto slope = [&](double at) {
    uint64_t h = mix64(mix64(channel) ^ uint64_t(int64_t(at)));
    return float(int64_t(h >> 40)) * 0x1p-23f - 1.0f;
  };
  float a = slope(cell) * t, b = slope(cell + 1) * (t - 1);
  float fade = t * t * t * (t * (t * 6 - 15) + 10);
  return 2 * (a + (b - a) * fade);
}

}  // namespace wellspring::avatar
