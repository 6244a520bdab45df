// SPDX-License-Identifier: Apache-2.0
// Computes the GGX lobes of a Bsdf's base: reflection by metal and dielectric, refraction, the thin
// pane's mirrored lobe, and multiple scattering between facets. Directions are local, z along the
// normal; values carry the cosine and count for radiance: beyond a boundary it is eta^2 denser.
#pragma once
#include "base/simd.h"
#include "light/material/bsdf_types.h"
#include "light/random/sampler.h"

namespace wellspring::light {

// Approximates the share of light from all around that a surface's gloss reflects: for light whose
// direction is not known.

// Holds the properties of a dielectric that determine it.
struct GlossFactors {
  float f0, roughness, share;  // reflectance at the normal; 0 to 1; share that is no metal
};
inline GlossFactors gloss_factors(const Material& m) {
  float root = (m.ior - 1) / (m.ior + 1);
  return {clean(root * root * m.specular), clean(m.roughness), 1 - clean(m.metallic)};
}

// Returns the albedo of a rough dielectric's reflection towards `cosine` of the normal (Karis 2014,
// "Physically Based Shading on Mobile": a fit).
inline Lanes gloss_albedo(Lanes f0, Lanes r, Lanes share, Lanes cosine) {
  Lanes steep = (1 - r) * (1 - r);
  Lanes power = all_lanes(1);  // 2^(-9.28 cosine), by (1 - x / 8)^8 of its logarithm
  for (int i = 0; i < 8; i++)
    power *= lanes_max(1 - cosine * (9.28f * 0.6931472f / 8), all_lanes(0));
  Lanes a = lanes_min(steep, power) * (1 - r) + (-0.0275f * r + 0.0425f);
  Lanes scale = -1.04f * a + (-0.572f * r + 1.04f), bias = 1.04f * a + (0.022f * r - 0.04f);
  Lanes albedo = (f0 * scale + (f0 > 0 ? bias : all_lanes(0))) * share;
  return lanes_min(lanes_max(albedo, all_lanes(0)), all_lanes(1));
}

// Holds the reflected and transmitted colour at a facet seen under this cosine.
struct FacetColor {
  vec3 reflect, transmit;
  float reflect_share;  // probability that sampling reflects
};
FacetColor facet_color(const Bsdf& bsdf, float cosine);

// Returns whether the base reflects or refracts at all.
inline bool has_gloss(const Bsdf& b) {
  return b.metallic > 0 || max_component(b.transmit) > 0 ||
         (b.eta != 1 && max_component(b.facet_base + b.facet_slope) > 0);
}

// Sets the colours of KHR_materials_specular, with the exact curve in place of Schlick's: the
// reflectance at normal incidence is tinted, that at grazing incidence is `specular`. `eta` must be
// set.
void set_facets(Bsdf& bsdf, float specular, vec3 color);
// Sets everything of the base but its frame, colours and alpha, which must be set. `transmission`:
// its share of the part that is no metal; `specular`, `specular_color`: the dielectric's.
void set_gloss(Bsdf& bsdf, const DielectricAlbedo& albedo, float transmission, float specular,
               vec3 specular_color);

// Returns the luminance that the base reflects towards the viewer without going beneath.
inline float eval_gloss_strength(const Bsdf& b) {
  float dielectric = (1 - b.metallic) * (1 - b.coat_passes);
  return b.metallic > 0 ? dielectric + b.metallic * luminance(b.metal) : dielectric;
}

// Returns the share that the dielectric reflects at this angle, or keeps from the layer beneath.
float eval_coat(const Bsdf& bsdf, float cosine);

// Computes value and density of the rough lobes; the sign of z of `l` is the side.
void eval_gloss(const Bsdf& bsdf, vec3 l, vec3& value, float& pdf);
// Draws a direction of the rough lobes; zero: none.
vec3 sample_gloss(const Bsdf& bsdf, Sampler& sampler);
// Draws one of the perfect lobes, world space; `u` in [0, 1) chooses.
BsdfSample sample_smooth_gloss(const Bsdf& bsdf, float u);

// Computes the layers on the base of a Bsdf: clearcoat and sheen. Directions are in world space;
// values carry the cosine.
//   clearcoat   GGX, exact Fresnel of index 1.5 (KHR_materials_clearcoat)
//   sheen       the distribution and masking of Estevez and Kulla 2017, "Production friendly
//               microfacet sheen BRDF", sections 2 and 3; sampled by the root of the cosine,
//               as it emits light near the horizon. Its model of smooth cloth gains light there:
//               the gain is scaled to 1
// Each dims what lies beneath by what it reflects in all towards the viewer, so that the sum loses
// and gains nothing. It is not reciprocal: with viewer and light exchanged the base differs by
// (1 - reflected(v)) / (1 - reflected(l)).

// Sets clearcoat, sheen and `beneath`; the base must be done.
void set_layers(Bsdf& bsdf, const Surface& surface, vec3 view);

inline bool has_clearcoat(const Bsdf& b) { return b.clearcoat.strength > 0; }
inline bool has_sheen(const Bsdf& b) { return max_component(b.sheen.color) > 0; }
// Return the chance of each among the specular lobes; the gloss of the base has the rest.
inline float clearcoat_share(const Bsdf& b) { return has_clearcoat(b) ? b.clearcoat.share : 0; }
inline float sheen_share(const Bsdf& b) { return has_sheen(b) ? b.sheen.share : 0; }
inline float gloss_share(const Bsdf& b) {
  return std::max(1 - clearcoat_share(b) - sheen_share(b), 0.0f);
}

// Adds value and density of the rough layers, each density times the layer's share.
void eval_layers(const Bsdf& bsdf, vec3 direction, vec3& value, float& pdf);
// Returns the perfect clearcoat's mirror image, not divided by any chance.
BsdfSample eval_clearcoat_mirror(const Bsdf& bsdf);
vec3 sample_clearcoat(const Bsdf& bsdf, Sampler& sampler);  // zero: none
vec3 sample_sheen(const Bsdf& bsdf, Sampler& sampler);

// Returns the directional albedo of white sheen; alpha is perceptual roughness squared.
float sheen_albedo(float cosine, float alpha);

}  // namespace wellspring::light
