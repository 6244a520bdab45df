// SPDX-License-Identifier: Apache-2.0
// The base's GGX lobes of a Bsdf: reflection by metal and dielectric, refraction, the thin pane's
// mirrored lobe, and what scatters between facets more than once. Directions are local, z along the
// normal; values carry the cosine and count for radiance: beyond a boundary it is eta^2 denser.
#pragma once
#include "light/material/bsdf_types.h"
#include "light/random/sampler.h"

namespace wellspring::light {

// Reflected and transmitted colour at a facet seen under this cosine.
struct FacetColor {
  vec3 reflect, transmit;
  float reflect_share;  // probability that sampling reflects
};
FacetColor facet_color(const Bsdf& bsdf, float cosine);

// Whether the base reflects or refracts at all.
inline bool has_gloss(const Bsdf& b) {
  return b.metallic > 0 || max_component(b.transmit) > 0 ||
         (b.eta != 1 && max_component(b.facet_base + b.facet_slope) > 0);
}

// KHR_materials_specular, with the exact curve in place of Schlick's: the reflectance at normal
// incidence is tinted, that at grazing incidence is `specular`. `eta` must be set.
void set_facets(Bsdf& bsdf, float specular, vec3 color);
// Sets everything of the base but its frame, colours and alpha, which must be set.
// `transmission`: its share of what is no metal; `specular`, `specular_color`: of the dielectric.
void set_gloss(Bsdf& bsdf, const DielectricAlbedo& albedo, float transmission, float specular,
               vec3 specular_color);

// Luminance that the base reflects towards the viewer without going beneath.
inline float eval_gloss_strength(const Bsdf& b) {
  float dielectric = (1 - b.metallic) * (1 - b.coat_passes);
  return b.metallic > 0 ? dielectric + b.metallic * luminance(b.metal) : dielectric;
}

// What the dielectric reflects from this angle, or keeps from the layer beneath.
float eval_coat(const Bsdf& bsdf, float cosine);

// Value and density of the rough lobes; z of `l` says to which side.
void eval_gloss(const Bsdf& bsdf, vec3 l, vec3& value, float& pdf);
// A direction of the rough lobes; zero: none.
vec3 sample_gloss(const Bsdf& bsdf, Sampler& sampler);
// One of the perfect lobes, world space; `u` in [0, 1) chooses.
BsdfSample sample_smooth_gloss(const Bsdf& bsdf, float u);

}  // namespace wellspring::light
