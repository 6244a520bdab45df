// SPDX-License-Identifier: Apache-2.0
// Describes how a surface scatters light: glTF 2.0 appendix B with KHR_materials_transmission,
// volume, ior, specular, clearcoat, sheen, anisotropy and dispersion. From the top:
//   clearcoat   GGX of index 1.5 with a normal of its own (bsdf_gloss.h)
//   sheen       cloth fibres (Estevez and Kulla 2017)
//   reflection  GGX: exact Fresnel for the dielectric, Schlick for the metal (bsdf_gloss.h)
//   beneath     Lambert, or transmission - thickness > 0: refraction (Walter et al. 2007); 0: a
//               thin pane, the reflection mirrored to the other side, straight through if smooth
// Nothing is lost on the way: light that facets keep from leaving is given back (Kulla and Conty
// 2017), each layer passes on what it does not reflect. The model is reciprocal but for the layers:
// clearcoat and sheen dim what lies beneath by the viewer's angle alone, as their glTF extensions
// do, and so do brushed surfaces, whose albedo is summed for the viewer's direction only.
//
// Lobes too smooth for any pixel to show the difference (alpha below smooth_alpha) are perfect
// ("delta"): they have no density and are found by sampling only. Directions point away from the
// surface, world space.
#pragma once
#include "base/simd.h"
#include "light/material/bsdf_types.h"
#include "light/random/sampler.h"
#include "world/surface.h"

namespace wellspring::light {

// Makes the BSDF. `direction`: direction of the ray that found the surface. `albedo`:
// dielectric_albedo(material.ior), with glass if the material transmits. `index`: index of
// refraction, instead of the material's; 0: the material's. `outside`: index of what lies in front
// of the surface; `albedo` is then that of the ratio or its inverse, whichever is at least 1.
Bsdf make_bsdf(const Surface& surface, const Material& material, vec3 direction,
               const DielectricAlbedo& albedo, float index = 0, float outside = 1);
// Returns the index of refraction: 0 in glTF means an infinite one, a surface that reflects
// everything.
float refractive_index(const Material& material);

bool has_diffuse(const Bsdf& bsdf);
bool has_specular(const Bsdf& bsdf);
bool is_smooth(const Bsdf& bsdf);       // nothing but perfect lobes: light sampling is useless here
bool is_clear_solid(const Bsdf& bsdf);  // the smooth boundary of a solid that light goes through

BsdfValue eval_bsdf(const Bsdf& bsdf, vec3 l);
// Returns the density of sample_bsdf(bsdf, lobes, ...) for a value of eval_bsdf.
float sample_bsdf_pdf(const Bsdf& bsdf, const BsdfValue& value, Lobes lobes);

BsdfSample sample_bsdf(const Bsdf& bsdf, Lobes lobes, Sampler& sampler);
// Returns the mirror image alone, of a surface whose specular lobes are perfect: no chance is
// involved.
BsdfSample eval_mirror(const Bsdf& bsdf);

// Returns whether it is a thin smooth pane, which lets straight light through. Shadow rays and
// paths both use this and pane_transmittance(), so that they agree.
bool is_pane(const Surface& surface, const Material& material);
vec3 pane_transmittance(const Surface& surface, const Material& material, vec3 direction);

// Does eval_bsdf eight at a time, for surfaces that most of a scene consists of: opaque, a diffuse
// layer and GGX facets over it, without coats (bsdf.h). It takes eight surfaces, or one against
// eight directions.

struct BsdfLanes {
  Lanes3 tangent, bitangent, normal, face, view;
  Lanes alpha_x, alpha_y, root_alpha;
  Lanes masked, scale;  // 1 + Smith's function of the view; factor of the distribution
  Lanes eta, metallic, dielectric_share;
  Lanes3 facet_base, facet_slope, metal, again;
  Lanes glossy;  // 1 or 0: there are facets
  Lanes coat_loss, coat_mirror, coat_fresnel, coat_scale, coated;
  Lanes loss_weight, fresnel_weight;
  const float* loss[2][lane_count];  // rows of the albedo tables, the smoother and the rougher
  const float* fresnel[2][lane_count];
};

// Returns whether lanes can hold the BSDF.
bool fits_lanes(const Bsdf& bsdf);
void set_lane(BsdfLanes& lanes, int lane, const Bsdf& bsdf);
BsdfLanes make_bsdf_lanes(const Bsdf& bsdf);  // in all lanes

// Holds values as BsdfValue does, but without the diffuse reflectance: the caller multiplies by it.
struct BsdfLanesValue {
  Lanes diffuse;
  Lanes3 specular;
};
BsdfLanesValue eval_bsdf_lanes(const BsdfLanes& lanes, const Lanes3& direction);

}  // namespace wellspring::light
