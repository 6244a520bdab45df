// SPDX-License-Identifier: Apache-2.0
// Light parted by wavelength (KHR_materials_dispersion). A walk is in colour until it meets a solid
// whose index of refraction depends on the wavelength; from then on it carries a cluster of
// wavelengths, of which the first, the hero, chooses its directions. The others are weighted by
// multiple importance sampling as if each had led (Wilkie et al. 2014, "Hero Wavelength Spectral
// Sampling", section 3). A perfect refraction sends each another way: only the hero is left.
//
// A channel of colour is the mean over wavelengths, weighted by a response that is nowhere negative
// and adds up to one: the matching functions of Wyman, Sloan and Shirley 2013 as Rec. 709, cut at
// zero. So white stays white, and no colour that reaches a picture is below zero or more than three
// times what an undispersed walk had brought.
#pragma once
#include <optional>

#include "light/material/bsdf.h"

namespace wellspring {

inline constexpr int wavelength_count = 4;

// What a walk carries.
struct Wavelengths {
  int carried = 0;  // 0: none yet, and the rest is not set; 1: the hero alone
  float place;      // of the hero in [0, 1); the others follow at equal steps
  vec3 value[wavelength_count];     // of the way so far, for each
  float density[wavelength_count];  // with which each had led along it
};

// The wavelength at a place in [0, 1), in nanometres: places are as dense as the mean response.
float wavelength_at(float place);
// What a walk of this wavelength alone brings to each channel; the mean over places is 1.
vec3 response_at(float place);
// Cauchy's formula by index and Abbe number, as the extension has it; at least 1.
float index_at(const Material& material, float wavelength);

bool is_dispersive(const Surface& surface, const Material& material);

// One BSDF more for each further wavelength. Lives as long as the Bsdf that points to it is used.
struct WavelengthSpread {
  Wavelengths before;
  bool fresh = false;  // the walk was in colour up to here
  Bsdf others[wavelength_count - 1];
};
// Parts the colours at a dispersive surface: `bsdf` becomes the hero's, and its eval_bsdf the mean
// over the cluster. `u` in [0, 1) places the hero if the walk was in colour. `outside`:
// make_bsdf's, the same for all wavelengths.
void spread_wavelengths(const Surface& surface, const Material& material, vec3 direction,
                        const DielectricAlbedo& albedo, const Wavelengths& carried, float u,
                        Bsdf& bsdf, std::optional<WavelengthSpread>& spread, float outside = 1);
// After sample_bsdf(bsdf, lobes, ...): weight and density of the cluster, and what it is now.
void carry_wavelengths(const WavelengthSpread& spread, const Bsdf& bsdf, Lobes lobes,
                       BsdfSample& sample, Wavelengths& carried);

// The same where the hero alone goes on, `sample` being its own (drawn without the spread).
void carry_hero(const WavelengthSpread& spread, BsdfSample& sample, Wavelengths& carried);
// Colour of what comes if the hero alone had brought it, over its colour now.
vec3 hero_tint(const WavelengthSpread& spread);

// Place of the one wavelength that is left; <0: the walk is in colour, or in a cluster, which is
// nearly that.
inline float hue_of(const Wavelengths& carried) {
  return carried.carried == 1 ? carried.place : -1;
}
// Walks of the eye and of light that meet are one walk where they have the same wavelength, which
// by chance they never have: those within a bandwidth are taken for it, as photons within a radius
// are for the same place. Factor on the product of both walks' colours; its mean over either hue is
// that of one walk.
inline constexpr float hue_bandwidth = 1.0f / 8;
vec3 meet_hues(float eye, float light);

// The hero's value made the cluster's; called by eval_bsdf.
void blend_wavelengths(const WavelengthSpread& spread, vec3 l, BsdfValue& value);

}  // namespace wellspring
