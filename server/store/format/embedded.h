// SPDX-License-Identifier: Apache-2.0
// Finds beside a picture's texels: its size, its EXIF orientation, its ICC profile.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "store/picture/texels.h"

namespace wellspring::store {

struct Embedded {
  int64_t width = 0, height = 0;  // texels as stored; 0: not found
  int channels = 0;               // colours of a JPEG or PNG, without alpha; 0: not found
  bool is_inverted = false;       // whether inks of CMYK are 255 where there is none (Adobe)
  Orientation orientation;
  std::vector<uint8_t> profile;  // ICC; empty: none
};

// Looks through the bytes of a PNG, JPEG or WebP. It refuses nothing: whatever is broken is as if
// it were not there.
Embedded find_embedded(std::span<const uint8_t> bytes);

}  // namespace wellspring::store
