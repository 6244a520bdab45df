// SPDX-License-Identifier: Apache-2.0
// Finds caustics: light that reaches a rough surface by sharp scatterings alone (Wald et al. 2002,
// section 4.1 and second sum of section 4). Photons leave the sources only towards spheres around
// what scatters sharply; their hits are kept in a PhotonGrid and looked up with a fixed radius. The
// result is biased: light is spread over the radius, and lost or won if surfaces bend or end within
// it.
#pragma once
#include "light/virtual/instant_pass.h"
#include "light/virtual/point_light_shading.h"
#include "light/sample/light_tables.h"

namespace wellspring::light {

// Returns the photons `[first, first + count)` of the sequence of `seed`; each stands for `share`
// of the light.
std::vector<Photon> shoot_caustic_photons(const Transport& transport,
                                          std::span<const CasterSphere> casters, int max_depth,
                                          uint64_t seed, uint32_t first, int count, float share);

// Adds the light of the photons around a place, scattered to the viewer. `cells`: of this grid, to
// be kept from one place to the next.
void shade_by_photons(const Transport& transport, const PhotonGrid& grid, int max_depth,
                      const LitPlace& place, PhotonCells& cells, PlaceLight& light);

// Returns the radius of pass `index`, which shrinks so that the mean of all passes converges to the
// truth (Knaus and Zwicker 2011, equation 15 with alpha 2/3).
float shrunk_radius(float first, uint32_t index);

}  // namespace wellspring::light
