// SPDX-License-Identifier: Apache-2.0
// Rays of the technique `instant_radiosity` that start at the eye: its mirror images, and what is
// left for a ray at a place lit by point lights (the list of paths in instant_radiosity.h).
#pragma once
#include "light/instant/point_light_shading.h"
#include "light/walk/walk.h"

namespace wellspring::light {

struct EyeLight {
  const Transport& transport;
  const InstantPass& pass;
  int max_depth = 8;
  int set = 0;  // of this pixel
};

// Where the surface that `walk` met parts colours, `bsdf` becomes the hero wavelength's, and refers
// to `spread`.
void part_seen_colors(const Transport& transport, const Walk& walk, const Surface& surface,
                      Sampler& sampler, Bsdf& bsdf, std::optional<WavelengthSpread>& spread);

// Radiance that comes along a walk which left a sharp lobe (or a pane), times its throughput.
vec3 follow_mirrors(const EyeLight& eye, Walk walk, Sampler& sampler);

// Radiance along a walk that left a rough lobe, of what point lights leave out: from nearer than
// the clip distance the share that clipping took, and through sharp things what is rough behind
// them.
vec3 gather_along(const EyeLight& eye, Walk walk, Sampler& sampler);

// Adds what point lights leave out: what clipping took, and rough light seen in sharp things.
void gather_rest(const EyeLight& eye, const LitPlace& place, Sampler& sampler, PlaceLight& light);

}  // namespace wellspring::light
