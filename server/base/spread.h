// SPDX-License-Identifier: Apache-2.0
// Sequences of which any number in a row is spread evenly.
#pragma once
#include <algorithm>
#include <cstdint>
#include <numeric>

#include "base/vec.h"

namespace wellspring {

// The i-th place within a pixel, 0 to 1: the additive recurrence of the plastic number's powers
// (Roberts 2018). They repeat after 1024.
inline vec2 spread_in_pixel(int i) {
  uint32_t n = uint32_t(i % 1024);
  auto part = [n](uint32_t step) { return float((0x80000000u + step * n) >> 8) * 0x1p-24f; };
  return {part(3242174889u), part(2447445414u)};
}

// Steps of about the golden ratio, round and round, reach all of `count` places once: neighbours in
// time lie far apart.
inline uint64_t golden_step(uint64_t count) {
  uint64_t step = std::max<uint64_t>(uint64_t(0.6180339887 * double(count)), 1);
  while (std::gcd(step, count) != 1) step++;
  return step;
}

}  // namespace wellspring
