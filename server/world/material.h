// SPDX-License-Identifier: Apache-2.0
// What a surface is made of: glTF 2.0 metallic-roughness (appendix B) with
// KHR_materials_transmission, ior, volume, emissive_strength, specular, clearcoat, sheen,
// anisotropy, dispersion and unlit. Factors are linear. Ambient occlusion maps are not used: a path
// tracer finds occlusion itself.
#pragma once
#include <limits>
#include <string>

#include "world/texture.h"

namespace wellspring::world {

enum class AlphaMode : uint8_t { opaque, mask, blend };

struct Material {
  std::string name;
  vec4 base_color{1};
  TextureRef base_color_texture;
  float metallic = 1, roughness = 1;      // perceptual roughness; alpha = roughness^2
  TextureRef metallic_roughness_texture;  // G roughness, B metallic
  TextureRef normal_texture;
  float normal_scale = 1;
  vec3 emission{0};  // radiance: emissiveFactor * emissiveStrength
  TextureRef emission_texture;
  AlphaMode alpha_mode = AlphaMode::opaque;
  float alpha_cutoff = 0.5f;
  bool double_sided = false;
  bool unlit = false;
  float ior = 1.5f;
  float transmission = 0;
  TextureRef transmission_texture;  // R
  float thickness = 0;              // 0: thin-walled
  TextureRef thickness_texture;     // G
  vec3 attenuation_color{1};
  float attenuation_distance = std::numeric_limits<float>::infinity();
  float dispersion = 0;  // 20 over the Abbe number
  float specular = 1;    // strength of the dielectric reflection; 0: a perfectly Lambertian surface
  TextureRef specular_texture;  // A
  vec3 specular_color{1};       // tints it at normal incidence
  TextureRef specular_color_texture;
  float clearcoat = 0, clearcoat_roughness = 0;
  TextureRef clearcoat_texture;            // R
  TextureRef clearcoat_roughness_texture;  // G
  TextureRef clearcoat_normal_texture;     // none: the coat is smooth, whatever lies beneath
  float clearcoat_normal_scale = 1;
  vec3 sheen_color{0};
  float sheen_roughness = 0;
  TextureRef sheen_color_texture;
  TextureRef sheen_roughness_texture;             // A
  float anisotropy = 0, anisotropy_rotation = 0;  // 0..1; radians from the tangent
  TextureRef anisotropy_texture;                  // RG: direction, B: strength
  // World::repaint() may change its colours and how its pictures lie: nothing may be concluded from
  // those.
  bool repaints = false;
};

// Whether its surfaces enclose a medium in which light is bent and tinted: it is met from both
// sides.
inline bool encloses_medium(const Material& m) {
  return m.transmission > 0 && m.thickness > 0 && m.metallic < 1;
}

// How a material looks for a while, told by what is added to it.
struct Repaint {
  vec4 base_color{0};
  vec3 emission{0};
  mat3 uv{0.0f};  // to the matrices of all its pictures' coordinates
  bool operator==(const Repaint&) const = default;
};

// Calls body(TextureRef&) for every picture a material may have.
template <class M, class Body>
void each_texture(M& m, Body&& body) {
  for (auto* use : {&m.base_color_texture, &m.metallic_roughness_texture, &m.emission_texture,
                    &m.transmission_texture, &m.thickness_texture, &m.specular_texture,
                    &m.specular_color_texture, &m.clearcoat_texture, &m.clearcoat_roughness_texture,
                    &m.sheen_color_texture, &m.sheen_roughness_texture, &m.anisotropy_texture,
                    &m.normal_texture, &m.clearcoat_normal_texture})
    body(*use);
}
// `m` changed so: colours stay within their ranges, what is not finite changes nothing.
Material repainted(const Material& m, const Repaint& change);
// The same with its own light times `brightness`.
Material dimmed(const Material& m, float brightness);

}  // namespace wellspring::world
