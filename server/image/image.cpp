// SPDX-License-Identifier: Apache-2.0
#include "image/image.h"

#include <algorithm>
#include <string_view>

#include "base/load_error.h"

namespace wellspring::image {

void check_size(int width, int height, int64_t most_pixels, const std::string& file) {
  if (std::min(width, height) < 1 || std::max(width, height) > largest_side)
    throw LoadError(file, "",
                    "picture of " + std::to_string(width) + "x" + std::to_string(height) +
                        " is larger than " + std::to_string(largest_side) + " a side");
  if (int64_t(width) * height > most_pixels)
    throw LoadError(file, "", "pictures have too many texels in total");
}

ImageCodes decode_codes(std::span<const uint8_t> bytes, int64_t most_pixels,
                        const std::string& file) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.starts_with("\x89PNG\r\n\x1a\n")) return decode_png(bytes, most_pixels, file);
  if (text.starts_with("RIFF") && text.substr(0, 12).ends_with("WEBP"))
    return decode_webp(bytes, most_pixels, file);
  if (text.starts_with("\xff\xd8\xff")) return decode_jpeg_codes(bytes, most_pixels, file);
  throw LoadError(file, "", "picture is neither PNG, JPEG nor WebP");
}

}  // namespace wellspring::image
