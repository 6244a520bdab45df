// SPDX-License-Identifier: Apache-2.0
// Small questions about one ray: boxes it may meet, and the hash that decides by chance about it.
#pragma once
#include <bit>

#include "base/rng.h"
#include "world/world.h"

namespace wellspring::world {

// Returns a hash of the ray's origin and direction and of a triangle, or of whatever else decides
// by chance about the ray.
inline uint64_t hash_ray(const Ray& ray, uint32_t instance, uint32_t triangle) {
  auto pair = [](float a, float b) {
    return uint64_t(std::bit_cast<uint32_t>(a)) << 32 | std::bit_cast<uint32_t>(b);
  };
  uint64_t hash = mix64(uint64_t(instance) << 32 | triangle);
  hash = mix64(hash ^ pair(ray.origin.x, ray.origin.y));
  hash = mix64(hash ^ pair(ray.origin.z, ray.direction.x));
  return mix64(hash ^ pair(ray.direction.y, ray.direction.z));
}

// Tests rays against boxes, slab by slab, in a form that compilers turn into vector code: std::fmin
// and std::fmax are calls.

// Cuts [near, far] of a ray down to the slab [low, high] of one axis; `inverse`: 1 / direction. A
// ray in the slab's very plane (0 times infinity) is not cut: the test is only whether the box may
// be met.
inline void cut_by_slab(float low, float high, float origin, float inverse, float& near,
                        float& far) {
  float a = (low - origin) * inverse, b = (high - origin) * inverse;
  float in = a < b ? a : b, out = a < b ? b : a;
  bool known = a + b == a + b;  // else the ray lies in the slab's plane
  in = known ? in : near;
  out = known ? out : far;
  near = in > near ? in : near;
  far = out < far ? out : far;
}

// Returns whether the ray may meet the box before t_max; never if its low is above its high.
inline bool meets(const Bounds& box, const Ray& ray, float t_max) {
  if (!(box.low.x <= box.high.x)) return false;
  vec3 inverse = 1.0f / ray.direction;
  float near = ray.t_min, far = t_max;
  for (int i = 0; i < 3; i++)
    cut_by_slab(box.low[i], box.high[i], ray.origin[i], inverse[i], near, far);
  return near <= far * 1.00001f;
}

}  // namespace wellspring::world
