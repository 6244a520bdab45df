// SPDX-License-Identifier: Apache-2.0
// Describes diffuse light as a function of the direction that a surface faces, near a normal:
//   light(seen) = light * max(0, 1 + dot(slope, seen - normal)),
// so folds that share a node, and maps of normals, are lit rightly by the light kept at the node.
// It is first order, as spherical harmonics of two bands are (Ramamoorthi and Hanrahan 2001, "An
// Efficient Representation for Irradiance Environment Maps"), but exact at the mesh's normal and
// fitted to directions within the tilts that maps of normals have: for light from one direction the
// cosine is followed to where it ends at 0.
#pragma once
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "base/simd.h"
#include "base/vec.h"

namespace wellspring::light {

// Returns what light from `direction` (unit, on the side of `normal`) adds to the slope, for each
// unit of the light that it brings there.
vec3 slope_of(vec3 direction, vec3 normal);

// Packs slopes in 32 bits: ten bits a coordinate; longer slopes are cut to most_slope.
inline constexpr float most_slope = 4;
inline uint32_t pack_slope(vec3 slope) {
  const float longest = max_component(glm::abs(slope));
  if (!(longest > 0) || !std::isfinite(longest)) return 0x20080200u;
  if (longest > most_slope) slope *= most_slope / longest;
  auto code = [](float x) { return uint32_t(512 + int(std::lrint(x * (511 / most_slope)))); };
  return code(slope.x) | code(slope.y) << 10 | code(slope.z) << 20;
}
inline vec3 unpack_slope(uint32_t code) {
  constexpr float unit = most_slope / 511;
  return (vec3(float(code & 1023), float(code >> 10 & 1023), float(code >> 20 & 1023)) - 512.0f) *
         unit;
}
inline void unpack_slope(const LaneBits& code, Lanes& x, Lanes& y, Lanes& z) {
  constexpr float unit = most_slope / 511;
  x = (to_float(code & 1023u) - 512.0f) * unit;
  y = (to_float(code >> 10 & 1023u) - 512.0f) * unit;
  z = (to_float(code >> 20 & 1023u) - 512.0f) * unit;
}

// Packs unit normals likewise; unpacked normals are unit but for rounding.
inline uint32_t pack_node_normal(vec3 normal) { return pack_slope(most_slope * normal); }
inline vec3 unpack_node_normal(uint32_t code) { return unpack_slope(code) * (1 / most_slope); }
inline void unpack_node_normal(const LaneBits& code, Lanes& x, Lanes& y, Lanes& z) {
  unpack_slope(code, x, y, z);
  x *= 1 / most_slope, y *= 1 / most_slope, z *= 1 / most_slope;
}

// Returns the light as a multiple of that at the normal that the slope is relative to.
inline float eval_slope(vec3 slope, vec3 normal, vec3 seen) {
  return std::max(1 + dot(slope, seen - normal), 0.0f);
}

}  // namespace wellspring::light
