// SPDX-License-Identifier: Apache-2.0
// Pictures on surfaces. glTF 2.0 section 3.8 (samplers, sRGB) and KHR_texture_transform.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/vec.h"
#include "world/texture_taps.h"

namespace wellspring::world {

// A decoded image. Exactly one of `texels8` (RGBA, 4 bytes a texel) and `texels` (float RGBA,
// linear) is filled; top row first.
struct Image {
  std::string name;
  int width = 0, height = 0;
  bool srgb = false;  // texels8's RGB are sRGB-encoded: decoded at look-up, before filtering
  std::vector<uint8_t> texels8;
  std::vector<vec4> texels;
};

// An image with a way to read it.
struct Texture {
  int image = -1;
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  bool nearest = false;  // nearest texel instead of bilinear
};

// A material's use of a texture. texture < 0: none, and the factor alone counts.
struct TextureRef {
  int texture = -1;
  int uv_set = 0;
  mat3 uv_transform{1};  // applied to (u, v, 1)
};

// Linear RGBA at (u, v). Any finite uv; non-finite uv gives texel 0. Texels that are not finite
// read as 0. An image without texels reads as 1 everywhere.
vec4 eval_texture(const Image& image, const Texture& texture, vec2 uv);
// The linear value of an 8-bit sRGB code (IEC 61966-2-1).
float decode_srgb(uint8_t code);

}  // namespace wellspring::world
