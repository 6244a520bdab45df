// SPDX-License-Identifier: Apache-2.0
// Computes what the VPLs of one set do to places (first sum of the paper's section 4). Up
// to 16 places are lit at once, by each light in turn: neighbours' shadow rays to one light are
// nearly the same ray.
#pragma once
#include <span>

#include "base/simd.h"
#include "light/virtual/instant_pass.h"
#include "light/sample/medium.h"

namespace wellspring::light {

// Holds up to 16 places side by side, and one point light as each of them sees it. A lane's result
// does not depend on the others.

// Holds one number of each lane.
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
  uint32_t lambertian = 0;  // lanes that are Lambertian, and nothing else
  uint32_t through = 0;     // lanes that scatter light from behind, too
  GroupLane3 position, normal, face;
  GroupLane3 origin;  // origin of a ray that leaves to the side of `face`
  GroupLane extent;   // SurfacePlace::extent
  SurfacePlace place(int i) const {
    SurfacePlace one;
    one.position = position.at(i);
    one.geometric_normal = face.at(i);
    one.extent = extent[i];
    return one;
  }
};

struct SeenLight {
  uint32_t active = 0;   // lanes that the light may reach
  GroupLane3 direction;  // to the light, of the length that `distance2` says
  GroupLane distance2;   // squared length of direction
  GroupLane cosine;      // cosine at the surface, with `direction` made unit
  GroupLane strength;    // incident light at a facing surface is this times the light's radiance
  // Shadow rays from the light to where light leaves each surface, which is at t = 1; those of
  // distant lights go from there to infinity. Rays with one origin make a narrower packet than rays
  // with one end.
  RayPacket rays;
};

// Finds how the lanes see a light. `radiance`: the light's, a punctual light's by its intensity.
void see_light(const LightTables& tables, const LitGroup& group, const PointLight& light,
               float clip2, SeenLight& seen, vec3& radiance);

// Holds a place to be lit, towards the viewer that its bsdf was made for.
struct LitPlace {
  const Surface* surface = nullptr;
  const Bsdf* bsdf = nullptr;
  const Media* media = nullptr;              // never null
  int depth = 1;                             // number of the eye's ray that ends here
  float sharp = mirror_alpha;                // lobes smoother than this are not lit here
  const Wavelengths* wavelengths = nullptr;  // those of the eye's walk; nullptr: none
  float hue() const { return wavelengths ? hue_of(*wavelengths) : -1; }
};

// Holds radiance towards the viewer by lobe; `exact`: by lights that every set has alike.
struct PlaceLight {
  vec3 diffuse{0}, specular{0}, exact_diffuse{0}, exact_specular{0};
  vec3 sum() const { return diffuse + specular + exact_diffuse + exact_specular; }
};

// Chooses the lights to ask: every `step`-th of a set's from a start drawn at random, which counts
// `step` times. `end`: those numbered [start, end) of all sets instead. `region`: the set's exact
// lights and those of a list of the region instead. `few`: these instead, by rays of their own.
struct SetShare {
  int set = 0;
  uint32_t start = 0, step = 1, end = 0;
  int region = -1, list = 0;
  std::span<const RegionLight> few = {};
};

// Adds to light[i] the light of places[i], for i below `count`, at most 16. A place's light does
// not depend on the other places.
void shade_by_point_lights(const Transport& transport, const InstantPass& pass,
                           const SetShare& choice, int max_depth, const LitPlace* places, int count,
                           PlaceLight* light);

// Holds irradiance by lights of the set alone, and by those that every set has alike.
struct LambertLight {
  GroupLane3 smooth, exact;
};
// Does the same for Lambertian places in air that the eye's first ray found: adds their irradiance.
void shade_lambert_by_point_lights(const Transport& transport, const InstantPass& pass,
                                   const SetShare& choice, int max_depth, const LitGroup& group,
                                   LambertLight& sum);

}  // namespace wellspring::light
