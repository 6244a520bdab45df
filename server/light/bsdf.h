// SPDX-License-Identifier: Apache-2.0
// How a surface scatters light: glTF 2.0 appendix B (a diffuse layer or a transmitting one under a
// rough dielectric, mixed with a rough metal) with KHR_materials_transmission, ior and volume.
//   diffuse     Lambert under the dielectric, coupled so that nothing is lost (Kulla and Conty
//   2017) reflection  GGX, exact Fresnel for the dielectric, Schlick for the metal transmission
//   thickness > 0: refraction by GGX (Walter et al. 2007); 0: a thin pane, the reflection
//               lobe mirrored to the other side, straight through where it is smooth
// Lobes smoother than any pixel could tell (alpha below smooth_alpha) are perfect ("delta"): they
// have no density and are found by sampling only. Directions point away from the surface, world
// space.
#pragma once
#include "light/albedo_table.h"
#include "light/sampler.h"
#include "world/surface.h"

namespace wellspring {

inline constexpr float smooth_alpha = 1e-3f;

struct Bsdf {
  vec3 tangent{1, 0, 0}, bitangent{0, 0, 1},
      normal{0, 1, 0};  // shading frame, on the viewer's side
  vec3 geometric_normal{0, 1, 0};
  vec3 view{0, 0, 1};    // local, z > 0
  vec3 diffuse{0};       // diffuse reflectance
  vec3 metal{1};         // reflectance of the metal at normal incidence
  vec3 metal_gain{1};    // what single scattering loses, given back
  float gloss_gain = 1;  // likewise for the reflection of rough glass; `transmit` has its own in it
  float metallic = 0;
  vec3 transmit{0};  // tint of what goes through
  float alpha = 1;   // 0: perfectly smooth
  float eta = 1.5f;  // index of refraction beyond over here
  bool thin = true;
  AlbedoRow coat;           // the dielectric's reflection in all, at this roughness
  float coat_passes = 1;    // 1 - reflected, from the viewer's angle
  float coat_scale = 1;     // 1 / (1 - average)
  float diffuse_share = 1;  // probability that sampling takes the diffuse lobe
};

// `direction`: of the ray that found the surface. `albedo`: dielectric_albedo(material.ior).
Bsdf make_bsdf(const Surface& surface, const Material& material, vec3 direction,
               const DielectricAlbedo& albedo);

bool has_diffuse(const Bsdf& bsdf);
bool has_specular(const Bsdf& bsdf);
bool is_smooth(const Bsdf& bsdf);  // nothing but perfect lobes: light sampling is useless here

// Each lobe's value times |cosine|, and the density with which sampling that lobe alone draws `l`.
// Perfect lobes count as 0.
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
