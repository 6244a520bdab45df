// SPDX-License-Identifier: Apache-2.0
// Caustics: light that reaches a rough surface by sharp scatterings alone (Wald et al. 2002,
// section 4.1 and second sum of section 4). Photons leave the sources only towards spheres around
// what scatters sharply; what they hit is kept in a PhotonGrid and asked with a fixed radius.
// Biased: light is spread over the radius, and lost or won where surfaces bend or end within it.
#pragma once
#include "light/instant/instant_pass.h"
#include "light/instant/point_light_shading.h"
#include "light/sample/light_tables.h"

namespace wellspring::light {

// The photons `[first, first + count)` of the sequence of `seed`; each stands for `share` of the
// light.
std::vector<Photon> shoot_caustic_photons(const Transport& transport,
                                          std::span<const CasterSphere> casters, int max_depth,
                                          uint64_t seed, uint32_t first, int count, float share);

// Adds the light of the photons around a place, scattered to the viewer. `cells`: of this grid, to
// be kept from one place to the next.
void shade_by_photons(const PhotonGrid& grid, int max_depth, const LitPlace& place,
                      PhotonCells& cells, PlaceLight& light);

// Radius of pass `index`: shrinks so that the mean of all passes converges to the truth (Knaus and
// Zwicker 2011, equation 15 with alpha 2/3).
float shrunk_radius(float first, uint32_t index);

}  // namespace wellspring::light
