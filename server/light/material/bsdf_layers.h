// SPDX-License-Identifier: Apache-2.0
// What lies on the base of a Bsdf: clearcoat and sheen. Directions are in world space; values carry
// the cosine.
//   clearcoat   GGX, exact Fresnel of index 1.5 (KHR_materials_clearcoat)
//   sheen       the distribution and masking of Estevez and Kulla 2017, "Production friendly
//               microfacet sheen BRDF", sections 2 and 3; sampled by the root of the cosine,
//               as it emits light near the horizon. Its model of smooth cloth gains light there:
//               that is scaled to 1
// Each dims what lies beneath by what it reflects in all towards the viewer, so that the sum loses
// and gains nothing. That is not reciprocal: with viewer and light exchanged the base differs by
// (1 - reflected(v)) / (1 - reflected(l)).
#pragma once
#include "light/material/bsdf_types.h"
#include "light/random/sampler.h"

namespace wellspring::light {

// Sets clearcoat, sheen and `beneath`; the base must be done.
void set_layers(Bsdf& bsdf, const Surface& surface, vec3 view);

inline bool has_clearcoat(const Bsdf& b) { return b.clearcoat.strength > 0; }
inline bool has_sheen(const Bsdf& b) { return max_component(b.sheen.color) > 0; }
// Chances of each among the specular lobes; the gloss of the base has the rest.
inline float clearcoat_share(const Bsdf& b) { return has_clearcoat(b) ? b.clearcoat.share : 0; }
inline float sheen_share(const Bsdf& b) { return has_sheen(b) ? b.sheen.share : 0; }
inline float gloss_share(const Bsdf& b) {
  return std::max(1 - clearcoat_share(b) - sheen_share(b), 0.0f);
}

// Value and density of the layers that have one, each density times the layer's share.
void eval_layers(const Bsdf& bsdf, vec3 direction, vec3& value, float& pdf);
// The perfect clearcoat's mirror image, not divided by any chance.
BsdfSample eval_clearcoat_mirror(const Bsdf& bsdf);
vec3 sample_clearcoat(const Bsdf& bsdf, Sampler& sampler);  // zero: none
vec3 sample_sheen(const Bsdf& bsdf, Sampler& sampler);

// Directional albedo of white sheen; alpha is perceptual roughness squared.
float sheen_albedo(float cosine, float alpha);

}  // namespace wellspring::light
