// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>

#include "frame/tonemap.h"

namespace wellspring::test {

inline float larger(float a, float b) { return a > b ? a : b; }
inline float usable(float x) {
  x = x > 0 ? x : 0.0f;  // false for NaN
  return x < brightest_shown ? x : brightest_shown;
}

inline float encode_exact(float x) {
  return x < 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
}

// One colour through the curve of tonemap(), with the exact transfer function: what its pictures
// are compared against. In [0, 1], sRGB-encoded.
inline vec3 tonemap_color(vec3 radiance, const Tonemap& settings) {
  vec3 c(usable(radiance.x * settings.exposure), usable(radiance.y * settings.exposure),
         usable(radiance.z * settings.exposure));
  float scale, offset;
  eval_shoulder(larger(max_component(c), shoulder_start), scale, offset);
  return {encode_exact(c.x * scale + offset), encode_exact(c.y * scale + offset),
          encode_exact(c.z * scale + offset)};
}

}  // namespace wellspring::test
