// SPDX-License-Identifier: Apache-2.0
// Fills the lanes of ray packets.
#pragma once
#include "base/simd.h"
#include "world/world.h"

namespace wellspring::world {

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

inline void set_ray(const Ray& ray, int lane, RayPacket& rays) {
  rays.origin_x[lane] = ray.origin.x, rays.origin_y[lane] = ray.origin.y;
  rays.origin_z[lane] = ray.origin.z;
  rays.direction_x[lane] = ray.direction.x, rays.direction_y[lane] = ray.direction.y;
  rays.direction_z[lane] = ray.direction.z;
  rays.t_max[lane] = ray.t_max;
  rays.from_eye = (rays.from_eye & ~(1u << lane)) | uint32_t(ray.from_eye) << lane;
}

// Sets lane_count rays, from lane `first` on, none of them from the eye.
inline void set_rays(const Lanes3& origin, const Lanes3& direction, Lanes t_max, int first,
                     RayPacket& rays) {
  store_lanes(rays.origin_x + first, origin.x);
  store_lanes(rays.origin_y + first, origin.y);
  store_lanes(rays.origin_z + first, origin.z);
  store_lanes(rays.direction_x + first, direction.x);
  store_lanes(rays.direction_y + first, direction.y);
  store_lanes(rays.direction_z + first, direction.z);
  store_lanes(rays.t_max + first, t_max);
  rays.from_eye &= ~(((1u << lane_count) - 1) << first);
}

}  // namespace wellspring::world
