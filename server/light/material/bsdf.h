// SPDX-License-Identifier: Apache-2.0
// How a surface scatters light: glTF 2.0 appendix B with KHR_materials_transmission, volume, ior,
// specular, clearcoat, sheen, anisotropy and dispersion. From the top:
//   clearcoat   GGX of index 1.5 with a normal of its own (bsdf_layers.h)
//   sheen       cloth fibres (Estevez and Kulla 2017)
//   reflection  GGX: exact Fresnel for the dielectric, Schlick for the metal (bsdf_gloss.h)
//   beneath     Lambert, or transmission - thickness > 0: refraction (Walter et al. 2007); 0: a
//               thin pane, the reflection mirrored to the other side, straight through if smooth
// Nothing is lost on the way: light that facets keep from leaving is given back (Kulla and Conty
// 2017), each layer passes on what it does not reflect. Reciprocal but for the layers: clearcoat
// and sheen dim what lies beneath by the viewer's angle alone, as their glTF extensions do, and so
// do brushed surfaces, whose albedo is summed for the viewer's direction only.
//
// Lobes smoother than any pixel could tell (alpha below smooth_alpha) are perfect ("delta"): they
// have no density and are found by sampling only. Directions point away from the surface, world
// space.
#pragma once
#include "light/material/albedo_table.h"
#include "light/random/sampler.h"
#include "world/surface.h"

namespace wellspring {

// Layers on top; the base gets what they leave.
struct Clearcoat {
  float strength = 0;  // 0: none, and the rest is not set
  float alpha, share;  // probability that sampling the specular lobes takes it
  vec3 tangent, bitangent, normal, view;  // its own frame, and the viewer in it
  float reflected;                        // at the viewer's angle
};
struct Sheen {
  vec3 color{0};  // black: none, and the rest is not set
  float alpha, share;
};

struct Bsdf {
  vec3 tangent{1, 0, 0}, bitangent{0, 0, 1},
      normal{0, 1, 0};  // shading frame, on the viewer's side
  vec3 geometric_normal{0, 1, 0};
  vec3 view{0, 0, 1};  // local, z > 0
  vec3 diffuse{0};     // diffuse reflectance
  vec3 metal{1};       // reflectance of the metal at normal incidence
  float metallic = 0;
  vec3 transmit{0};  // tint of what goes through
  float alpha = 1;   // 0: perfectly smooth
  vec2 alphas{1};    // along tangent and bitangent
  float eta = 1.5f;  // index of refraction beyond over here
  bool thin = true;
  bool within = false;  // the viewer is on the inner side of a solid's surface
  // The dielectric reflects facet_base + facet_slope * Fresnel (KHR_materials_specular).
  vec3 facet_base{0}, facet_slope{1};
  float dielectric_share = 1;  // of the reflection: the rest is metal

  // Shares of light by angle, all at this roughness.
  float root_alpha = 1;
  AlbedoRow loss, fresnel;       // of facets; not set where smooth
  AlbedoRow glass_here, glass_beyond;  // what glass loses, from either side
  // What scatters more than once: each times the loss at the other direction and its cosine.
  vec3 again{0}, glass_again{0}, glass_again_beyond{0};
  float again_share = 0, again_here = 1;  // that sampling takes it, and then to this side
  float again_scale = 0;                  // of its density
  bool has_coat = false;  // the dielectric keeps something from the diffuse layer
  // That is coat_loss * loss + coat_mirror * (1 - loss) + coat_fresnel * (1 - loss) *
  // fresnel.
  float coat_loss = 0, coat_mirror = 0, coat_fresnel = 0;
  float coat_passes = 1;    // 1 - reflected, from the viewer's angle
  float coat_scale = 1;     // 1 / (1 - average)
  float diffuse_share = 1;  // probability that sampling takes the diffuse lobe

  Clearcoat clearcoat;
  Sheen sheen;
  float beneath = 1;  // what the layers leave to all of the above
  const struct WavelengthSpread* spread = nullptr;  // colours parted here (dispersion.h); borrowed
};

// `direction`: of the ray that found the surface. `albedo`: dielectric_albedo(material.ior), with
// glass where the material transmits. `index`: of refraction, instead of the material's; 0: none.
// `outside`: of what lies in front of the surface; `albedo` is then that of the ratio or its
// inverse, whichever is at least 1.
Bsdf make_bsdf(const Surface& surface, const Material& material, vec3 direction,
               const DielectricAlbedo& albedo, float index = 0, float outside = 1);
// Index of refraction: 0 in glTF means an infinite one, a surface that reflects everything.
float refractive_index(const Material& material);

bool has_diffuse(const Bsdf& bsdf);
bool has_specular(const Bsdf& bsdf);
bool is_smooth(const Bsdf& bsdf);  // nothing but perfect lobes: light sampling is useless here

// Each lobe's value times |cosine|, and the density with which sampling that lobe alone draws `l`.
// Perfect lobes count as 0. Sheen and clearcoat are specular lobes.
struct BsdfValue {
  vec3 diffuse{0}, specular{0};
  float diffuse_pdf = 0, specular_pdf = 0;
};
BsdfValue eval_bsdf(const Bsdf& bsdf, vec3 l);

enum class Lobes : uint8_t { diffuse, specular, all };
// Density of sample_bsdf(bsdf, lobes, ...) for a value of eval_bsdf.
float sample_bsdf_pdf(const Bsdf& bsdf, const BsdfValue& value, Lobes lobes);

enum class Bounce : uint8_t {
  reflect,
  refract,
  pass
};  // pass: straight through a thin smooth pane
struct BsdfSample {
  vec3 direction{0};
  vec3 weight{0};  // value * |cosine| / density; zero: the path ends
  float pdf = 0;   // 0: a perfect lobe
  Bounce bounce = Bounce::reflect;
};
BsdfSample sample_bsdf(const Bsdf& bsdf, Lobes lobes, Sampler& sampler);
// The mirror image alone, of a surface whose specular lobes are perfect: no chance is involved.
BsdfSample eval_mirror(const Bsdf& bsdf);

// A thin smooth pane lets straight light through: shadow rays and paths agree on how much by this.
bool is_pane(const Surface& surface, const Material& material);
vec3 pane_transmittance(const Surface& surface, const Material& material, vec3 direction);

}  // namespace wellspring
