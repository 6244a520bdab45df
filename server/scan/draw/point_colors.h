// SPDX-License-Identifier: Apache-2.0
// Gives points linear colours: those that were captured, and scales of colour for other values.
#pragma once
#include <cstdint>

#include "base/vec.h"

namespace wellspring::scan {

// Return the colour, and the intensity as grey, of a word of NodePoints::color.
vec3 captured_color(uint32_t word);
vec3 intensity_color(uint32_t word);
// Returns a colour for a share of the height, 0 to 1: from blue over green to red.
vec3 height_color(float share);
// Returns a colour for a class of ASPRS (LAS 1.4 R15, table 17); what it does not name is grey.
vec3 class_color(uint8_t code);

}  // namespace wellspring::scan
