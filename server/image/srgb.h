// SPDX-License-Identifier: Apache-2.0
// Decodes 8-bit sRGB codes (IEC 61966-2-1).
#pragma once
#include <array>
#include <cstdint>

#include "base/layers.h"

namespace wellspring::image {

// Linear values of the codes.
extern const std::array<float, 256> srgb_table;
inline float decode_srgb(uint8_t code) { return srgb_table[code]; }

}  // namespace wellspring::image
