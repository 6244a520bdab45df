// SPDX-License-Identifier: Apache-2.0
// What the point lights of one set do to places (first sum of the paper's section 4). Up to 16
// places at once, for each light in turn: neighbours' shadow rays to one light are nearly the same
// ray.
#pragma once
#include <span>

#include "base/simd.h"
#include "light/instant/instant_pass.h"
#include "light/sample/medium.h"

namespace wellspring::light {

// Up to 16 places side by side, and one point light as each of them sees it. A lane's answer does
// not depend on the others.

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

// A place to be lit, towards the viewer its bsdf was made for.
struct LitPlace {
  const Surface* surface = nullptr;
  const Bsdf* bsdf = nullptr;
  const Media* media = nullptr;              // never null
  int depth = 1;                             // number of the eye's ray that ends here
  float sharp = mirror_alpha;                // its lobes smoother than this are somebody else's
  const Wavelengths* wavelengths = nullptr;  // of the eye's walk; nullptr: none
  float hue() const { return wavelengths ? hue_of(*wavelengths) : -1; }
};

// Radiance towards the viewer by lobe; `exact`: of lights that every set has alike.
struct PlaceLight {
  vec3 diffuse{0}, specular{0}, exact_diffuse{0}, exact_specular{0};
  vec3 sum() const { return diffuse + specular + exact_diffuse + exact_specular; }
};

// Of a set's lights, every `step`-th from a start drawn at random counts `step` times. `end`: those
// numbered [start, end) of all sets instead. `region`: the set's exact lights and those of a
// list of the region instead. `few`: these instead, by rays of their own.
struct SetShare {
  int set = 0;
  uint32_t start = 0, step = 1, end = 0;
  int region = -1, list = 0;
  std::span<const RegionLight> few = {};
};

// Adds to light[i] that of places[i], i below `count`, at most 16. What one place gets does not
// depend on the others.
void shade_by_point_lights(const Transport& transport, const InstantPass& pass,
                           const SetShare& choice, int max_depth, const LitPlace* places, int count,
                           PlaceLight* light);

// Irradiance by lights of the set alone, and by those that every set has alike.
struct LambertLight {
  GroupLane3 smooth, exact;
};
// The same of Lambertian places in air that the eye's first ray found: adds their irradiance.
void shade_lambert_by_point_lights(const Transport& transport, const InstantPass& pass,
                                   const SetShare& choice, int max_depth, const LitGroup& group,
                                   LambertLight& sum);

}  // namespace wellspring::light
