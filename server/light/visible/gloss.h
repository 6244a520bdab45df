// SPDX-License-Identifier: Apache-2.0
// How a place reflects small lights as highlights: by GGX (glTF 2.0, appendix B), no clearcoat.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/simd.h"
#include "base/vec.h"

namespace wellspring::light {

// Highlights of rougher surfaces, of no metal, are not told from their diffuse light.
inline constexpr float least_rough = 0.6f, least_metal = 0.05f;

struct Gloss {
  vec3 f0{0};  // reflectance towards the normal
  float roughness = 1, metallic = 0;
};

// The same in two planes of a picture. `code`: roots of f0 in the low bytes, red first, then
// roughness, each times 255; 0: no highlights.
struct GlossCode {
  uint32_t code = 0;
  uint8_t metallic = 0;  // times 255
};
inline GlossCode pack_gloss(const Gloss& gloss) {
  if (gloss.roughness >= least_rough && gloss.metallic < least_metal) return {};
  auto byte = [](float x) { return uint32_t(255 * std::clamp(x, 0.0f, 1.0f) + 0.5f); };
  GlossCode packed{byte(gloss.roughness) << 24, uint8_t(byte(gloss.metallic))};
  for (int c = 0; c < 3; c++) packed.code |= byte(std::sqrt(gloss.f0[c])) << (8 * c);
  return packed;
}

// Eight of them.
struct GlossLanes {
  Lanes f0[3], roughness, metallic;
};
inline GlossLanes unpack_gloss(const uint32_t* codes, const uint8_t* metallic) {
  GlossLanes gloss;
  for (int i = 0; i < lane_count; i++) {
    for (int c = 0; c < 3; c++) {
      const float root = float(codes[i] >> (8 * c) & 255) * (1 / 255.0f);
      gloss.f0[c][i] = root * root;
    }
    gloss.roughness[i] = float(codes[i] >> 24) * (1 / 255.0f);
    gloss.metallic[i] = float(metallic[i]) * (1 / 255.0f);
  }
  return gloss;
}

}  // namespace wellspring::light
