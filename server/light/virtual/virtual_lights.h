// SPDX-License-Identifier: Apache-2.0
// Chooses virtual point lights (Keller 1997) among the texels of reflective shadow maps. Each
// counts the more the less likely it was to be chosen, so that in the mean they are all of the
// maps.
//
// A virtual light stands for the surface around it. Its light at a distance d is that of a disc of
// radius r which is as large as that surface, seen along its axis: intensity / (d^2 + r^2) instead
// of / d^2, the limit of many small ones. So a virtual light never adds more than its surface
// itself would, and no pixel is far too bright where one lies in a corner.
#pragma once
#include <span>

#include "base/memory.h"
#include "light/virtual/reflective_shadow_map.h"

namespace wellspring::light {

// Holds the lights side by side as vector units want them, filled up with lights of no intensity to
// a multiple of eight.
struct VirtualLights {
  int count = 0;                      // without the lights that fill up
  int padded = 0;                     // with them
  RawVector<float> x, y, z;           // scene coordinates
  RawVector<float> nx, ny, nz;        // unit normal: light leaves on its side, by the cosine
  RawVector<float> red, green, blue;  // intensity along the normal, W/sr
  RawVector<float> radius2;           // square metres; above 0
  RawVector<vec3> target;       // end of shadow rays, clear of the surface; one for each of `count`
  std::vector<double> weights;  // one for each texel: workspace
  vec3 intensity(size_t i) const { return {red[i], green[i], blue[i]}; }
};

// Fills up to `padded` from `count`.
void fill_up(VirtualLights& lights);

// Holds a place that is visible; `by_effect` computes the effect of texels there.
struct LitProbe {
  vec3 position{0}, normal{0, 1, 0};
  float depth = 0;  // from the eye: tells how exact the place is
};

// Chooses about settings.virtual_lights, fewer if few texels have flux. One map and seed always
// give the same choice; if texels change little, so does it. `by_effect` without probes is
// `by_flux`.
void choose_virtual_lights(const ReflectiveShadowMap& map, const SplatSettings& settings,
                           SplatSeed seed, std::span<const LitProbe> probes, VirtualLights& lights);

}  // namespace wellspring::light
