// SPDX-License-Identifier: Apache-2.0
// Up to 16 places side by side, and one point light as each of them sees it. A lane's answer does
// not depend on the others.
#pragma once
#include "base/simd3.h"
#include "light/instant/instant_pass.h"

namespace wellspring::light {

// One number of each lane.
struct alignas(64) GroupLane {
  static constexpr int lanes = RayPacket::lanes, halves = lanes / lane_count;
  float v[lanes];
  float& operator[](int i) { return v[i]; }
  float operator[](int i) const { return v[i]; }
  Lanes half(int h) const { return load_lanes(v + h * lane_count); }
  void set_half(int h, Lanes a) { store_lanes(v + h * lane_count, a); }
};
struct GroupLane3 {
  GroupLane x, y, z;
  void set(int i, vec3 p) { x[i] = p.x, y[i] = p.y, z[i] = p.z; }
  vec3 at(int i) const { return {x[i], y[i], z[i]}; }
  Lanes3 half(int h) const { return {x.half(h), y.half(h), z.half(h)}; }
  void set_half(int h, Lanes3 a) { x.set_half(h, a.x), y.set_half(h, a.y), z.set_half(h, a.z); }
};

struct LitGroup {
  uint32_t used = 0;        // lanes with a place
  uint32_t lambertian = 0;  // that are Lambert's, and nothing else
  uint32_t through = 0;     // that scatter light from behind, too
  GroupLane3 position, normal, face;
  GroupLane3 origin;  // of a ray that leaves to the side of `face`
  GroupLane extent;   // SurfacePlace
  SurfacePlace place(int i) const {
    SurfacePlace one;
    one.position = position.at(i);
    one.geometric_normal = face.at(i);
    one.extent = extent[i];
    return one;
  }
};

struct SeenLight {
  uint32_t active = 0;   // lanes that it may emit light on
  GroupLane3 direction;  // to it; not unit where `distance2` says so
  GroupLane distance2;   // squared length of direction
  GroupLane cosine;      // at the surface, unit
  GroupLane strength;    // incident light at a facing surface is this times the light's radiance
  RayPacket rays;  // from it to where they would leave each surface, which is at t = 1; or on to
                   // infinity. Rays with one origin make a narrower packet than rays with one end.
};

// `radiance`: the light's, a punctual light's by its intensity.
void see_light(const LightTables& tables, const LitGroup& group, const PointLight& light,
               float clip2, SeenLight& seen, vec3& radiance);

}  // namespace wellspring::light
