// SPDX-License-Identifier: Apache-2.0
#include "world/load/gltf_image.h"

#include <cmath>

#include "base/load_error.h"
#include "image/image.h"

namespace wellspring::world {
namespace {

float decode_srgb16(uint16_t code) {
  float s = float(code) / 65535.0f;
  return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
}

}  // namespace

std::string decode_image(std::span<const uint8_t> bytes, bool srgb, Image& image,
                         int64_t& texels_left) {
  ImageCodes read;
  try {
    read = decode_codes(bytes, texels_left, image.name);
  } catch (const LoadError& error) {
    return error.what_;
  }
  image.width = read.width, image.height = read.height;
  image.texels8 = std::move(read.codes8);
  image.texels.resize(read.codes16.size() / 4);
  for (size_t i = 0; i < read.codes16.size(); i++) {
    const uint16_t code = read.codes16[i];
    image.texels[i / 4][int(i % 4)] =
        srgb && i % 4 < 3 ? decode_srgb16(code) : float(code) / 65535.0f;
  }
  texels_left -= int64_t(image.width) * image.height;
  image.srgb = srgb && image.texels.empty();
  return "";
}

}  // namespace wellspring::world
