// SPDX-License-Identifier: Apache-2.0
#include "light/material/material_use.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "light/material/bsdf.h"

namespace wellspring::light {
namespace {

TexelRange scan(const Image& image) {
  TexelRange range{vec4(std::numeric_limits<float>::infinity()),
                   vec4(-std::numeric_limits<float>::infinity())};
  if (!image.texels.empty()) {
    for (vec4 t : image.texels)
      for (int c = 0; c < 4; c++) {
        float value = std::isfinite(t[c]) ? t[c] : 0;  // as it is read
        range.low[c] = std::min(range.low[c], value);
        range.high[c] = std::max(range.high[c], value);
      }
    return range;
  }
  if (image.texels8.size() < 4) return {};
  std::array<uint8_t, 4> low{255, 255, 255, 255}, high{0, 0, 0, 0};
  for (size_t i = 0; i + 3 < image.texels8.size(); i += 4)
    for (size_t c = 0; c < 4; c++) {
      low[c] = std::min(low[c], image.texels8[i + c]);
      high[c] = std::max(high[c], image.texels8[i + c]);
    }
  for (int c = 0; c < 4; c++) {
    bool curved = image.srgb && c < 3;
    range.low[c] = curved ? decode_srgb(low[size_t(c)]) : float(low[size_t(c)]) / 255;
    range.high[c] = curved ? decode_srgb(high[size_t(c)]) : float(high[size_t(c)]) / 255;
  }
  return range;
}

TexelRange color_range(const Mesh& mesh) {
  TexelRange range;
  if (mesh.colors.empty()) return range;
  range.low = range.high = mesh.colors[0];
  for (vec4 c : mesh.colors) {
    range.low = glm::min(range.low, c);
    range.high = glm::max(range.high, c);
  }
  return range;
}

// Returns a roughness as the BSDF reads it: NaN is smooth.
float usable_roughness(float r) { return r > 0 ? std::min(r, 1.0f) : 0.0f; }
bool perfect(float roughness) { return roughness * roughness < smooth_alpha; }
bool same_color(const TexelRange& r) { return vec3(r.low) == vec3(r.high); }

}  // namespace

const TexelRange& TextureRanges::image(int index) {
  auto [known, fresh] = known_.try_emplace(index);
  if (fresh) known->second = scan(scene_.images[size_t(index)]);
  return known->second;
}

TexelRange TextureRanges::of(const TextureRef& reference) {
  if (reference.texture < 0 || size_t(reference.texture) >= scene_.textures.size()) return {};
  int index = scene_.textures[size_t(reference.texture)].image;
  if (index < 0 || size_t(index) >= scene_.images.size()) return {};
  return image(index);
}

MaterialUse merge(const MaterialUse& a, const MaterialUse& b) {
  return {a.visible || b.visible,
          a.receives || b.receives,
          a.scatters || b.scatters,
          a.emits || b.emits,
          a.emission_varies || b.emission_varies,
          a.pane || b.pane,
          a.solid || b.solid,
          a.absorbs || b.absorbs,
          a.disperses || b.disperses,
          a.spectral || b.spectral,
          a.coated || b.coated,
          a.sharp || b.sharp,
          std::max(a.metal, b.metal)};
}

MaterialUse find_material_use(const Material& m, const Mesh& mesh, TextureRanges& ranges) {
  MaterialUse use;
  TexelRange colors = color_range(mesh);
  bool cut_out = m.alpha_mode != AlphaMode::opaque;
  if (cut_out && !m.repaints) {
    float highest = m.base_color.w * colors.high.w * ranges.of(m.base_color_texture).high.w;
    if (m.alpha_mode == AlphaMode::mask ? highest < m.alpha_cutoff : !(highest > 0)) return use;
  }
  use.visible = true;
  use.spectral = knows_wavelengths(m);
  auto base_high = [&] {
    if (m.repaints) return 1.0f;
    return max_component(vec3(m.base_color) * vec3(colors.high) *
                         vec3(ranges.of(m.base_color_texture).high));
  };
  if (m.unlit) {
    use.emits = (m.repaints || max_component(vec3(m.base_color)) > 0) && base_high() > 0;
    use.emission_varies = use.emits && (cut_out || m.repaints || !mesh.colors.empty() ||
                                        !same_color(ranges.of(m.base_color_texture)));
    return use;
  }
  use.receives = true;
  if (m.repaints) {
    use.emits = use.emission_varies = true;
  } else if (max_component(m.emission) > 0) {
    TexelRange picture = ranges.of(m.emission_texture);
    use.emits = max_component(m.emission * vec3(picture.high)) > 0;
    use.emission_varies = use.emits && (cut_out || !same_color(picture));
  }

  TexelRange rough_metal = ranges.of(m.metallic_roughness_texture);
  float smoothest = usable_roughness(m.roughness * rough_metal.low.y),
        roughest = usable_roughness(m.roughness * rough_metal.high.y);
  float least_metal = m.metallic * rough_metal.low.z;
  bool transmits =
      m.transmission > 0 && least_metal < 1 && ranges.of(m.transmission_texture).high.x > 0;
  use.solid = transmits && m.thickness > 0;
  use.pane = transmits && !use.solid && perfect(smoothest) && base_high() > 0;
  use.absorbs = use.solid && std::isfinite(m.attenuation_distance) && m.attenuation_distance > 0 &&
                std::min({m.attenuation_color.x, m.attenuation_color.y, m.attenuation_color.z}) < 1;
  use.disperses = use.solid && m.dispersion > 0 && m.ior != 1;

  bool clearcoat = m.clearcoat > 0 && ranges.of(m.clearcoat_texture).high.x > 0;
  bool sheen = max_component(m.sheen_color) > 0 &&
               max_component(m.sheen_color * vec3(ranges.of(m.sheen_color_texture).high)) > 0;
  use.coated = clearcoat || sheen;
  if (least_metal >= all_metal && smoothest >= least_demodulated_roughness) {
    bool filtered =
        smoothest >= least_filtered_roughness && !use.coated && m.anisotropy == 0 && !transmits;
    use.metal = filtered ? MetalDemodulation::light : MetalDemodulation::reflectance;
  }

  bool reflects = m.metallic > 0 || m.ior != 1;
  if (smoothest < caustic_roughness) use.sharp = reflects || transmits;
  if (clearcoat) {
    float coat = m.clearcoat_roughness * ranges.of(m.clearcoat_roughness_texture).low.y;
    use.sharp = use.sharp || usable_roughness(coat) < caustic_roughness;
  }
  // If it is perfect everywhere, and nothing diffuse lies beneath, no light is ever sampled on it.
  bool diffuse_beneath = least_metal < 1 && base_high() > 0 &&
                         (m.transmission < 1 || ranges.of(m.transmission_texture).low.x < 1);
  use.scatters = diffuse_beneath || !perfect(roughest) || use.coated;
  return use;
}

}  // namespace wellspring::light
