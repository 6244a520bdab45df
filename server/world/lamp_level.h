// SPDX-License-Identifier: Apache-2.0
// How bright a lamp of the scene is: 0 off, lamp_full as the scene has it.
#pragma once
#include <cmath>
#include <cstdint>
#include <vector>

namespace wellspring::world {

using LampLevel = uint8_t;
using LampLevels = std::vector<LampLevel>;  // of each of the scene's lamps
inline constexpr LampLevel lamp_full = 255;

// Times the scene's own light; exactly 0 and 1 at the ends. The square of the level, so that steps
// in the dark are small, too.
inline float brightness_of(LampLevel level) {
  const float share = float(level) / float(lamp_full);
  return share * share;
}

// The level of that brightness, 0 to 1.
inline LampLevel level_of(float brightness) {
  return LampLevel(std::lround(float(lamp_full) * std::sqrt(brightness)));
}

}  // namespace wellspring::world
