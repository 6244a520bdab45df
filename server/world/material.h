// SPDX-License-Identifier: Apache-2.0
// What a surface is made of: glTF 2.0 metallic-roughness (appendix B) with KHR_materials_transmission,
// ior, volume, emissive_strength and unlit. Factors are linear. Ambient occlusion maps are not used:
// a path tracer finds occlusion itself.
#pragma once
#include <limits>
#include <string>

#include "world/texture.h"

namespace wellspring {

enum class AlphaMode : uint8_t { opaque, mask, blend };

struct Material {
  std::string name;
  vec4 base_color{1};
  TextureRef base_color_texture;
  float metallic = 1, roughness = 1;  // perceptual roughness; alpha = roughness^2
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
};

}  // namespace wellspring
