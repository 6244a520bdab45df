// SPDX-License-Identifier: Apache-2.0
// Fills the lanes of ray packets.
#pragma once
#include "base/simd.h"
#include "world/one_ray.h"
#include "world/world.h"

namespace wellspring::world {

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
