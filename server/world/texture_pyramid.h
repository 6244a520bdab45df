// SPDX-License-Identifier: Apache-2.0
// Pictures made smaller beforehand (Williams, "Pyramidal Parametrics", 1983), for those who look
// once a pixel: what is far away neither sparkles nor costs a cache miss a texel.
#pragma once
#include <bit>
#include <cstdint>
#include <vector>

#include "base/simd.h"
#include "world/texture.h"

namespace wellspring::world {

// Half the size, a quarter, and so on down to one texel; the picture itself is not repeated. Texels
// are the roots of linear RGB in [0, 1], 8 bits each.
struct TexturePyramid {
  struct Level {
    int width = 0, height = 0;
    std::vector<uint32_t> texels;
  };
  std::vector<Level> levels;
};

// Averages of linear light; a third of the picture's memory. Without levels for pictures of floats,
// which may exceed 1, and for those read by the nearest texel, where edges are meant.
TexturePyramid make_pyramid(const Image& image);

// Which of the levels is read by a pixel that is `texels` texels of the picture wide; 0: the
// picture itself.
inline int pyramid_level(float texels) {
  // The logarithm of the width to base 2, rounded: the exponent of the width over the root of one
  // half.
  int level = int(std::bit_cast<uint32_t>(texels * 1.41421356f) >> 23 & 255) - 127;
  return texels > 1 ? level : 0;
}

// Linear RGB at (u, v) as seen by a pixel that is `texels` texels of the picture wide. As
// eval_texture() where that is less than about one and a half.
vec3 eval_pyramid(const Image& image, const TexturePyramid& pyramid, const Texture& texture,
                  vec2 uv, float texels);

// The same for eight places at once, bilinear in the roots of light where it is made smaller.
// False: not done, because the picture is of floats, or read by the nearest texel.
bool eval_pyramid(const Image& image, const TexturePyramid& pyramid, const Texture& texture,
                  Lanes u, Lanes v, float texels, Lanes (&rgb)[3]);

}  // namespace wellspring::world
