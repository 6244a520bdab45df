// SPDX-License-Identifier: Apache-2.0
// Virtual point lights (Keller 1997), chosen among the texels of reflective shadow maps. Each is
// worth more the less likely it was to be chosen, so that in the mean they are all of the maps.
//
// A virtual light stands for the surface around it. Its light at a distance d is that of a disc of
// radius r which is as large as that surface, seen along its axis: intensity / (d^2 + r^2) instead
// of / d^2, the limit of many small ones. So what a virtual light does is never more than what its
// surface itself would show, and nothing sparks where one lies in a corner.
#pragma once
#include <span>

#include "base/memory.h"
#include "light/splat/reflective_shadow_map.h"

namespace wellspring::light {

// Side by side as vector units want them, filled up with lights of no intensity to a multiple of
// eight.
struct VirtualLights {
  int count = 0;                      // without those
  int padded = 0;                     // with them
  RawVector<float> x, y, z;           // scene coordinates
  RawVector<float> nx, ny, nz;        // unit normal: light leaves on its side, by the cosine
  RawVector<float> red, green, blue;  // intensity along the normal, W/sr
  RawVector<float> radius2;           // square metres; above 0
  RawVector<vec3> target;       // of each of `count`: end of shadow rays, clear of the surface
  std::vector<double> weights;  // of each texel: workspace
  vec3 intensity(size_t i) const { return {red[i], green[i], blue[i]}; }
};

// Makes `padded` of `count`.
void fill_up(VirtualLights& lights);

// Somewhere that is seen; `by_effect` asks what texels do there.
struct LitProbe {
  vec3 position{0}, normal{0, 1, 0};
  float depth = 0;  // from the eye: how precisely the place is known
};

// Of one map and seed always the same choice; where texels change little, so does it. About
// settings.virtual_lights, fewer where few texels have flux. `by_effect` without probes is
// `by_flux`.
void choose_virtual_lights(const ReflectiveShadowMap& map, const SplatSettings& settings,
                           SplatSeed seed, std::span<const LitProbe> probes, VirtualLights& lights);

}  // namespace wellspring::light
