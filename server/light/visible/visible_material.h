// SPDX-License-Identifier: Apache-2.0
// What the visibility pass (light/visible/visibility.h) has to know of materials before it begins.
#pragma once
#include "light/material/material_use.h"
#include "light/visible/gloss.h"
#include "light/visible/guides.h"
#include "light/walk/first_surface.h"

namespace wellspring::light {

// How the reflectance of a material is found.
enum class Reflectance : uint8_t {
  scaled,  // a factor times base colour, and no less than a floor
  base,    // base colour and metallic of each place say all
  traced,  // ask a ray
};

// What demodulated_albedo() makes of base colour.
struct DemodulationScale {
  float factor = 1, floor = 0;
};
inline Reflectance find_reflectance(const Material& m, MetalDemodulation metal,
                                    DemodulationScale& scale) {
  if (m.transmission > 0 || m.anisotropy > 0) return Reflectance::traced;
  if (m.metallic > 0 && m.metallic_roughness_texture.texture >= 0) return Reflectance::base;
  bool kept = metal != MetalDemodulation::none;
  scale = {kept ? 1 : 1 - clean(m.metallic),
           kept ? least_demodulated_metal * clean(m.metallic) : 0};
  return Reflectance::scaled;
}

// RasterSettings::see_through of what is a clear pane everywhere.
inline uint8_t pane_kind(const Material& m) {
  bool clear = m.transmission == 1 && m.transmission_texture.texture < 0 && m.thickness == 0 &&
               m.metallic == 0 && m.roughness == 0 && m.alpha_mode == AlphaMode::opaque && !m.unlit;
  if (!clear || m.anisotropy > 0 || m.clearcoat > 0 || m.sheen_color != vec3(0)) return 0;
  bool alike = m.base_color_texture.texture < 0 && m.specular_texture.texture < 0 &&
               m.specular_color_texture.texture < 0 && m.normal_texture.texture < 0 &&
               m.emission_texture.texture < 0;
  return alike ? 1 : 2;
}

// Some place of it may be: what it shows is that of others (light/visible/guides.h).
inline bool may_be_polished(const Material& m, TextureRanges& ranges) {
  if (m.unlit) return false;
  if (m.transmission > 0) return true;
  float roughness = m.roughness * ranges.of(m.metallic_roughness_texture).low.y;
  return roughness * roughness < sharp_alpha;
}

// Some place of it has highlights (light/visible/gloss.h), which are seen without rays.
inline bool may_gloss(const Material& m, TextureRanges& ranges) {
  if (m.unlit || m.transmission > 0) return false;
  const TexelRange& range = ranges.of(m.metallic_roughness_texture);
  return m.roughness * range.low.y < least_rough || m.metallic * range.high.z >= least_metal;
}

// Some place of it reflects light that depends on the view beyond what rough paint does.
inline constexpr float least_matte = 0.5f;  // roughness, from which nothing shines
inline bool may_shine(const Material& m, TextureRanges& ranges) {
  if (m.unlit) return false;
  const TexelRange& range = ranges.of(m.metallic_roughness_texture);
  return m.metallic * range.high.z > 0 || m.roughness * range.low.y < least_matte ||
         m.transmission > 0 || m.clearcoat > 0;
}

// All of it is diffuse but for a gloss so rough that it shows the light around as the diffuse layer
// does: an illumination map says all of its light.
inline constexpr float least_plain_roughness = 0.45f, most_plain_metal = 0.02f;
inline bool is_plain(const Material& m, TextureRanges& ranges) {
  if (m.unlit || m.transmission > 0 || m.alpha_mode == AlphaMode::blend || m.emission != vec3(0))
    return false;
  if (m.clearcoat > 0 || m.sheen_color != vec3(0)) return false;
  const TexelRange& range = ranges.of(m.metallic_roughness_texture);
  return m.roughness * range.low.y >= least_plain_roughness &&
         m.metallic * range.high.z <= most_plain_metal;
}

}  // namespace wellspring::light
