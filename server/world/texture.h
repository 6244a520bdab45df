// SPDX-License-Identifier: Apache-2.0
// Defines pictures on surfaces: glTF 2.0 section 3.8 (samplers, sRGB) and KHR_texture_transform.
#pragma once
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/simd.h"
#include "base/vec.h"
#include "image/srgb.h"

namespace wellspring::store {
struct LargePicture;  // store/picture/sample_picture.h
}

namespace wellspring::world {

// Finds where a texture coordinate falls between texels (glTF 2.0 section 3.8.4).

enum class Wrap : uint8_t { repeat, mirror, clamp };

// Holds the two texels on one axis and the weight of the second.
struct Taps {
  int first, second;
  float weight;
};

// Returns where `coordinate` (texture space, any finite value) falls on an axis of `size` texels,
// in [0, size].
inline float wrapped(float coordinate, int size, Wrap wrap) {
  switch (wrap) {
    case Wrap::repeat: coordinate -= std::floor(coordinate); break;
    case Wrap::mirror:
      coordinate -= 2 * std::floor(0.5f * coordinate);
      if (coordinate > 1) coordinate = 2 - coordinate;
      break;
    case Wrap::clamp: coordinate = glm::clamp(coordinate, 0.0f, 1.0f); break;
  }
  return coordinate * float(size);
}

inline Taps linear_taps(float coordinate, int size, Wrap wrap) {
  float x = wrapped(coordinate, size, wrap) - 0.5f;
  float low = std::floor(x);
  int first = int(low), second = first + 1;
  if (wrap == Wrap::repeat) {
    if (first < 0) first += size;
    if (second >= size) second -= size;
  }
  // Mirrored and clamped pictures meet their own edge texel at the border.
  return {glm::clamp(first, 0, size - 1), glm::clamp(second, 0, size - 1), x - low};
}

// Holds a decoded image. Exactly one of `texels8` (RGBA, 4 bytes a texel) and `texels` (float RGBA,
// linear) is filled; top row first.
struct Image {
  std::string name;
  int width = 0, height = 0;
  bool srgb = false;  // texels8's RGB are sRGB-encoded: decoded at look-up, before filtering
  std::vector<uint8_t> texels8;
  std::vector<vec4> texels;
  // Not null: the texels are a small version of this picture, which who is near enough sees.
  std::shared_ptr<const LargePicture> large;
};

// Texels of all pictures of a scene together.
constexpr int64_t image_texel_limit = int64_t(1) << 28;
// Decodes a picture file (image/image.h): eight-bit pictures keep their codes; 16-bit ones become
// linear floats. `texels_left` shrinks by the decoded texels. Returns an empty string, or what is
// wrong.
std::string decode_image(std::span<const uint8_t> bytes, bool srgb, Image& image,
                         int64_t& texels_left);

// Holds an image with a way to read it.
struct Texture {
  int image = -1;
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  bool nearest = false;  // nearest texel instead of bilinear
};

// Holds a material's use of a texture. texture < 0: none, and the factor alone counts.
struct TextureRef {
  int texture = -1;
  int uv_set = 0;
  mat3 uv_transform{1};  // applied to (u, v, 1)
};

// Returns linear RGBA at (u, v). Any finite uv; non-finite uv gives texel 0. Texels that are not
// finite read as 0. An image without texels reads as 1 everywhere.
vec4 eval_texture(const Image& image, const Texture& texture, vec2 uv);

// Makes pictures smaller beforehand (Williams, "Pyramidal Parametrics", 1983), for code that looks
// once a pixel: far surfaces neither sparkle nor cost a cache miss a texel.

// Holds a picture at half the size, a quarter, and so on down to one texel, but not the picture
// itself. Texels are the roots of linear RGB in [0, 1], 8 bits each.
struct TexturePyramid {
  struct Level {
    int width = 0, height = 0;
    std::vector<uint32_t> texels;
  };
  std::vector<Level> levels;
};

// Makes a pyramid of averages of linear light; it takes a third of the picture's memory. There are
// no levels for pictures of floats, which may exceed 1.
TexturePyramid make_pyramid(const Image& image);

// Returns the level that a pixel reads which is `texels` texels of the picture wide; 0: the picture
// itself.
inline int pyramid_level(float texels) {
  // This is the logarithm of the width to base 2, rounded: the exponent of the width over the root
  // of one half.
  int level = int(std::bit_cast<uint32_t>(texels * 1.41421356f) >> 23 & 255) - 127;
  return texels > 1 ? level : 0;
}

// Returns linear RGB at (u, v) as seen by a pixel that is `texels` texels of the picture wide. Does
// as eval_texture() if that is less than about one and a half.
vec3 eval_pyramid(const Image& image, const TexturePyramid& pyramid, const Texture& texture,
                  vec2 uv, float texels);

// Does the same for eight places at once, bilinear in the roots of light at smaller levels. False:
// not done, because the picture is of floats, or read by the nearest texel.
bool eval_pyramid(const Image& image, const TexturePyramid& pyramid, const Texture& texture,
                  Lanes u, Lanes v, float texels, Lanes (&rgb)[3]);

}  // namespace wellspring::world
