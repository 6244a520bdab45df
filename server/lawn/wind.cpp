// SPDX-License-Identifier: Apache-2.0
#include "lawn/wind.h"

#include <cmath>

namespace wellspring::lawn {
namespace {

// Returns the sine, right to 1e-6 for the few hundred radians that places are apart: whole half
// turns are taken off, the rest is a Taylor series.
Lanes sine(const Lanes& x) {
  const LaneMask half_turns = round_lanes(x * (1 / pi));
  const Lanes whole = __builtin_convertvector(half_turns, Lanes);
  const Lanes r = (x - whole * 3.140625f) - whole * 9.67653589793e-4f;
  const Lanes r2 = r * r;
  Lanes series = all_lanes(-2.5052108e-8f);
  series = series * r2 + 2.7557319e-6f;
  series = series * r2 - 1.9841270e-4f;
  series = series * r2 + 8.3333333e-3f;
  series = series * r2 - 1.6666667e-1f;
  series = series * r2 * r + r;
  return lanes_as<Lanes>(lanes_as<LaneMask>(series) ^ (half_turns << 31));
}

}  // namespace

WindNow::WindNow(const Wind& wind, double time) {
  const bool blows = std::isfinite(wind.strength) && std::isfinite(time);
  const float strength = blows ? wind.strength : 0;
  lean_ = strength * wind.lean;
  for (size_t i = 0; i < waves_.size(); i++) {
    const WindWave& from = wind.waves[i];
    const double phase = blows ? std::remainder(from.phase - from.rate * time, 2 * M_PI) : 0;
    waves_[i] = {strength * from.push.x, strength * from.push.y, from.wave.x, from.wave.y,
                 float(phase)};
  }
}

void WindNow::push_at(const Lanes& x, const Lanes& z, Lanes& push_x, Lanes& push_z) const {
  push_x = all_lanes(lean_.x), push_z = all_lanes(lean_.y);
  for (const Wave& wave : waves_) {
    const Lanes s = sine(wave.wave_x * x + wave.wave_z * z + wave.phase);
    push_x += wave.push_x * s, push_z += wave.push_z * s;
  }
}

}  // namespace wellspring::lawn
