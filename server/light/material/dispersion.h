// SPDX-License-Identifier: Apache-2.0
// Spreads light by wavelength: KHR_materials_dispersion, or a measured index of refraction. From
// the first such solid on a walk carries a cluster of wavelengths (wavelengths.h). A perfect
// refraction sends each another way: only the hero is left.
#pragma once
#include <optional>

#include "light/material/bsdf.h"
#include "light/material/wavelengths.h"

namespace wellspring::light {

// Returns the index of refraction: measured, or by Cauchy's formula with index and Abbe number, as
// the extension has it; at least 1.
float index_at(const SpectralTables& tables, const Material& material, float wavelength);

bool is_dispersive(const Surface& surface, const Material& material);

// Spreads the colours at a dispersive surface: `bsdf` becomes the hero's, and its eval_bsdf the
// mean over the cluster. `place`: hero_place(), if the walk has all wavelengths. `outside`:
// make_bsdf's, the same for all wavelengths.
void spread_wavelengths(const SpectralTables& tables, const Surface& surface,
                        const Material& material, vec3 direction, const DielectricAlbedo& albedo,
                        const Wavelengths& carried, float place, Bsdf& bsdf,
                        std::optional<WavelengthSpread>& spread, float outside = 1);
// Sets density of `sample` after sample_bsdf(bsdf, lobes, ...), and the cluster as it is now; the
// weight stays without the cluster's tint.
void carry_wavelengths(const WavelengthSpread& spread, const Bsdf& bsdf, Lobes lobes,
                       BsdfSample& sample, Wavelengths& carried);

// Does the same if the hero alone goes on.
void carry_hero(const WavelengthSpread& spread, Wavelengths& carried);
// Puts the change of tint by what was carried into the weight, for walks that keep their light in
// colours.
void tint_weight(const WavelengthSpread& spread, Wavelengths& carried, BsdfSample& sample);
// Returns the colour of light that the hero alone had brought, over the cluster's.
vec3 hero_tint(const WavelengthSpread& spread);

}  // namespace wellspring::light
