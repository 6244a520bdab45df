// SPDX-License-Identifier: Apache-2.0
// Places within a pixel, of which any number in a row is spread evenly: the additive recurrence of
// the plastic number's powers (Roberts 2018).
#pragma once
#include <cstdint>

#include "base/vec.h"

namespace wellspring {

// Of the i-th, 0 to 1; they repeat after 1024.
inline vec2 spread_in_pixel(int i) {
  uint32_t n = uint32_t(i % 1024);
  auto part = [n](uint32_t step) { return float((0x80000000u + step * n) >> 8) * 0x1p-24f; };
  return {part(3242174889u), part(2447445414u)};
}

}  // namespace wellspring
