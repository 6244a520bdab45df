// SPDX-License-Identifier: Apache-2.0
// Makes texels of picture files (image/image.h), which are known by their first bytes, not by their
// names.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "world/texture.h"

namespace wellspring::world {

// Texels of all pictures of a scene together.
constexpr int64_t image_texel_limit = int64_t(1) << 28;

// Decodes a picture: eight-bit pictures keep their codes; 16-bit ones become linear floats.
// `texels_left` shrinks by the decoded texels. Returns an empty string, or what is wrong.
std::string decode_image(std::span<const uint8_t> bytes, bool srgb, Image& image,
                         int64_t& texels_left);

}  // namespace wellspring::world
