// SPDX-License-Identifier: Apache-2.0
// Packs colours of light into 32 bits: 9 bits a channel and a common exponent of 5.
#pragma once
#include <algorithm>
#include <bit>
#include <cstdint>

#include "base/simd.h"
#include "base/vec.h"

namespace wellspring {

// The largest value that the format holds.
inline constexpr float rgb9e5_max = 65408.0f;

// Packs radiance. NaN and negative values become 0. `random` decides the rounding: its three bytes
// are the dither of the channels; 0x808080 rounds to nearest.
inline uint32_t pack_rgb9e5(vec3 c, uint32_t random = 0x808080u) {
  float r = c.x > 0 ? std::min(c.x, rgb9e5_max) : 0.0f;
  float g = c.y > 0 ? std::min(c.y, rgb9e5_max) : 0.0f;
  float b = c.z > 0 ? std::min(c.z, rgb9e5_max) : 0.0f;
  float largest = std::max(r, std::max(g, b));
  // The exponent is chosen so that largest * 2^-(exponent-15-9) stays below 511 after rounding up.
  int exponent =
      std::max(0, int(std::bit_cast<uint32_t>(largest * (512.0f / 511.0f)) >> 23) - 127 + 16);
  exponent = std::min(exponent, 31);
  float scale = std::bit_cast<float>(uint32_t(127 + 24 - exponent) << 23);
  float dr = float(random & 255) * (1.0f / 256), dg = float((random >> 8) & 255) * (1.0f / 256),
        db = float((random >> 16) & 255) * (1.0f / 256);
  uint32_t ir = std::min(511u, uint32_t(r * scale + dr)),
           ig = std::min(511u, uint32_t(g * scale + dg)),
           ib = std::min(511u, uint32_t(b * scale + db));
  return ir | ig << 9 | ib << 18 | uint32_t(exponent) << 27;
}
inline vec3 unpack_rgb9e5(uint32_t p) {
  float scale = std::bit_cast<float>(((p >> 27) + 127 - 24) << 23);
  return vec3(float(p & 511), float((p >> 9) & 511), float((p >> 18) & 511)) * scale;
}

// Unpacks as unpack_rgb9e5() of base/rgb9e5.h does, eight colours at a time.

inline void unpack_rgb9e5(const LaneBits& p, Lanes& r, Lanes& g, Lanes& b) {
  Lanes unit = lanes_as<Lanes>(((p >> 27) + (127 - 24)) << 23);
  r = to_float(p & 511u) * unit;
  g = to_float((p >> 9) & 511u) * unit;
  b = to_float((p >> 18) & 511u) * unit;
}

}  // namespace wellspring
