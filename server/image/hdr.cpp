// SPDX-License-Identifier: Apache-2.0
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_HDR
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 16384
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wsign-compare"
#include <stb_image.h>
#pragma GCC diagnostic pop

#include <cmath>
#include <memory>

#include "base/load_error.h"
#include "image/image.h"

namespace wellspring::image {

LinearImage decode_hdr(std::span<const uint8_t> bytes, int64_t most_pixels,
                       const std::string& file) {
  const auto fail = [&](const std::string& what) { throw LoadError(file, "", what); };
  const auto fail_to_decode = [&] {
    fail(std::string("picture cannot be decoded: ") + stbi_failure_reason());
  };
  if (bytes.size() < 2 || bytes[0] != '#' || bytes[1] != '?') fail("not a Radiance .hdr picture");
  if (bytes.size() > size_t(INT32_MAX)) fail("picture file is too large");
  LinearImage image;
  int components = 0;
  if (!stbi_info_from_memory(bytes.data(), int(bytes.size()), &image.width, &image.height,
                             &components))
    fail_to_decode();
  check_size(image.width, image.height, most_pixels, file);
  const std::unique_ptr<float, void (*)(void*)> texels(
      stbi_loadf_from_memory(bytes.data(), int(bytes.size()), &image.width, &image.height,
                             &components, 3),
      stbi_image_free);
  if (!texels) fail_to_decode();
  image.color.resize(size_t(image.width) * size_t(image.height));
  for (size_t i = 0; i < 3 * image.color.size(); i++) {
    const float value = texels.get()[i];
    image.color[i / 3][int(i % 3)] = std::isfinite(value) && value > 0 ? value : 0;
  }
  return image;
}

}  // namespace wellspring::image
