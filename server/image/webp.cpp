// SPDX-License-Identifier: Apache-2.0
#include <webp/decode.h>

#include "base/load_error.h"
#include "image/image.h"

namespace wellspring::image {

ImageCodes decode_webp(std::span<const uint8_t> bytes, int64_t most_pixels,
                       const std::string& file) {
  const auto fail = [&](const char* what) { throw LoadError(file, "", what); };
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(bytes.data(), bytes.size(), &features) != VP8_STATUS_OK)
    fail("picture cannot be decoded: its WebP header is broken");
  if (features.has_animation) fail("picture is a moving one (WebP)");
  ImageCodes image{features.width, features.height, {}, {}};
  check_size(image.width, image.height, most_pixels, file);
  image.codes8.resize(size_t(image.width) * size_t(image.height) * 4);
  if (!WebPDecodeRGBAInto(bytes.data(), bytes.size(), image.codes8.data(), image.codes8.size(),
                          4 * image.width))
    fail("picture cannot be decoded: its WebP data is broken or cut off");
  return image;
}

}  // namespace wellspring::image
