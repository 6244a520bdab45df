// SPDX-License-Identifier: Apache-2.0
// Pictures: PNG by libpng and JPEG by libjpeg-turbo to Image, found out by their first bytes,
// not by their names.
#pragma once
#include <span>
#include <string>

#include "world/texture.h"

namespace wellspring::world {

constexpr int image_side_limit = 16384;
constexpr int64_t image_texel_limit = int64_t(1) << 28;  // all pictures of a scene together

// Eight-bit pictures keep their codes; 16-bit ones become linear floats. `texels_left` shrinks by
// what was decoded. Returns an empty string, or what is wrong.
std::string decode_image(std::span<const uint8_t> bytes, bool srgb, Image& image,
                         int64_t& texels_left);
// Radiance .hdr to linear floats. Returns an empty string, or what is wrong.
std::string decode_radiance(std::span<const uint8_t> bytes, Image& image);

}  // namespace wellspring::world
