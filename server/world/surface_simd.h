// SPDX-License-Identifier: Apache-2.0
// What surface.h says of Lambertian surfaces, of eight hits side by side. Each lane's answer is its
// own: what the other lanes hold does not matter.
#pragma once
#include "base/simd3.h"
#include "world/surface.h"

namespace wellspring::world {

struct LambertSurfaceLanes {
  Lanes3 position, geometric_normal, normal, base_color;
  Lanes extent{};
  unsigned bent = 0;  // bit i: the normal of lane i may be another than the geometric one
  SurfacePlace place(int lane) const {
    SurfacePlace one;
    one.position = position.at(lane);
    one.geometric_normal = geometric_normal.at(lane);
    one.extent = extent[lane];
    return one;
  }
};
// eval_lambert_surface of hits[i] for the bits of `active`, met by rays of those unit directions.
LambertSurfaceLanes eval_lambert_surfaces(const World& world, const Lanes3& direction,
                                          const Hit* hits, unsigned active);
Lanes3 offset_origins(const LambertSurfaceLanes& surface, const Lanes3& direction);

}  // namespace wellspring::world
