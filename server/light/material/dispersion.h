// SPDX-License-Identifier: Apache-2.0
// Spreads light by wavelength (KHR_materials_dispersion). A walk is in colour until it meets a
// solid whose index of refraction depends on the wavelength; from then on it carries a cluster of
// wavelengths, of which the first, the hero, chooses its directions. The others are weighted by
// multiple importance sampling as if each had led (Wilkie et al. 2014, "Hero Wavelength Spectral
// Sampling", section 3). A perfect refraction sends each another way: only the hero is left.
#pragma once
#include <optional>

#include "light/material/bsdf.h"
#include "light/material/wavelengths.h"

namespace wellspring::light {

// Evaluates Cauchy's formula by index and Abbe number, as the extension has it; at least 1.
float index_at(const Material& material, float wavelength);

bool is_dispersive(const Surface& surface, const Material& material);

// Spreads the colours at a dispersive surface: `bsdf` becomes the hero's, and its eval_bsdf the
// mean over the cluster. `u` in [0, 1) places the hero if the walk was in colour. `outside`:
// make_bsdf's, the same for all wavelengths.
void spread_wavelengths(const Surface& surface, const Material& material, vec3 direction,
                        const DielectricAlbedo& albedo, const Wavelengths& carried, float u,
                        Bsdf& bsdf, std::optional<WavelengthSpread>& spread, float outside = 1);
// Sets weight and density of the cluster after sample_bsdf(bsdf, lobes, ...), and the cluster as it
// is now.
void carry_wavelengths(const WavelengthSpread& spread, const Bsdf& bsdf, Lobes lobes,
                       BsdfSample& sample, Wavelengths& carried);

// Does the same if the hero alone goes on, `sample` being its own (drawn without the spread).
void carry_hero(const WavelengthSpread& spread, BsdfSample& sample, Wavelengths& carried);
// Returns the colour of light that the hero alone had brought, over its colour now.
vec3 hero_tint(const WavelengthSpread& spread);

}  // namespace wellspring::light
