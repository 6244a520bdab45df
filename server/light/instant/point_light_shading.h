// SPDX-License-Identifier: Apache-2.0
// What the point lights of one set do to places (first sum of the paper's section 4). Up to 16
// places at once, for each light in turn: neighbours' shadow rays to one light are nearly the same
// ray.
#pragma once
#include <span>

#include "light/instant/lit_group.h"
#include "light/sample/medium.h"

namespace wellspring::light {

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
