// SPDX-License-Identifier: Apache-2.0
// The frames a Bsdf's lobes live in, made from whatever normals and tangents a surface has.
#pragma once
#include <cmath>

#include "light/material/bsdf_types.h"
#include "light/random/warp.h"

namespace wellspring::light {

inline vec3 to_local(const Bsdf& b, vec3 w) {
  return {dot(w, b.tangent), dot(w, b.bitangent), dot(w, b.normal)};
}
inline vec3 to_world(const Bsdf& b, vec3 w) {
  return b.tangent * w.x + b.bitangent * w.y + b.normal * w.z;
}

// `high` at most, and no less than nothing; NaN is 0.
inline float clean(float x, float high = 1) { return x > 0 ? std::min(x, high) : 0.0f; }
inline vec3 clean(vec3 c, float high = 1) {
  return {clean(c.x, high), clean(c.y, high), clean(c.z, high)};
}

// GGX alpha of a perceptual roughness; 0: perfectly smooth, as NaN is.
inline float alpha_of(float roughness) {
  float r = roughness > 0 ? std::min(roughness, 1.0f) : 0.0f;
  return r * r < smooth_alpha ? 0 : r * r;
}

// A mapped or interpolated normal may face away from the viewer or mirror him into the surface;
// then it is turned just far enough that its reflection leaves the surface.
inline vec3 usable_normal(vec3 n, vec3 geometric, vec3 v) {
  if (n == geometric && dot(v, n) > 0) return n;
  float least = std::min(0.01f, 0.9f * dot(v, geometric));
  vec3 mirrored = 2 * dot(v, n) * n - v;
  float height = dot(mirrored, geometric);
  if (dot(n, v) > 0 && height >= least) return n;
  mirrored = dot(n, v) > 0 ? mirrored + geometric * (least - height) : geometric;
  vec3 between = normalize(mirrored) + v;
  float length2 = dot(between, between);
  return length2 > 1e-12f ? between / std::sqrt(length2) : geometric;
}

// Axes around `n` of which the first lies as near to `along` as it can; false: it can not.
inline bool make_frame_along(vec3 n, vec3 along, vec3& tangent, vec3& bitangent) {
  along -= n * dot(n, along);
  float length2 = dot(along, along);
  if (!(length2 > 1e-6f) || !std::isfinite(length2)) return false;
  tangent = along / std::sqrt(length2);
  bitangent = cross(n, tangent);
  return true;
}

}  // namespace wellspring::light
