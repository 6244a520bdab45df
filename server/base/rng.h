// SPDX-License-Identifier: Apache-2.0
// Makes random numbers that can be replayed: a sample's stream is a function of (seed, x, y, index)
// alone, never of the thread that drew it. Generator: PCG-XSH-RR 64/32, O'Neill 2014, sections 6.3
// and 7.1.
#pragma once
#include <algorithm>
#include <cstdint>
#include <numeric>

#include "base/layers.h"
#include "base/vec.h"

namespace wellspring {

// Mixes 64 bits well (SplitMix64's finaliser; Steele, Lea, Flood 2014).
inline uint64_t mix64(uint64_t z) {
  z += 0x9e3779b97f4a7c15ull;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

// Returns the address of one pixel sample as a seed. Neighbouring seeds are hashed apart first, so
// that none draws the numbers of another pixel a row further.
inline uint64_t sample_seed(uint64_t seed, uint32_t x, uint32_t y, uint32_t index) {
  return mix64(mix64(mix64(seed) ^ (uint64_t(x) << 32 | y)) ^ index);
}

struct Rng {
  uint64_t state = 0, increment = 1;
  explicit Rng(uint64_t seed = 0) : increment((mix64(seed ^ 0x5851f42d4c957f2dull) << 1) | 1) {
    next();
    state += seed;
    next();
  }
  uint32_t next() {
    uint64_t old = state;
    state = old * 6364136223846793005ull + increment;
    uint32_t shifted = uint32_t(((old >> 18) ^ old) >> 27), rotation = uint32_t(old >> 59);
    return (shifted >> rotation) | (shifted << ((32 - rotation) & 31));
  }
  // Returns a number, uniform in [0, 1): 24 bits, never 1.
  float uniform() { return float(next() >> 8) * 0x1p-24f; }
};

// Makes sequences of which any part, of any length, is spread evenly.

// Returns the i-th place within a pixel, 0 to 1: the additive recurrence of the plastic number's
// powers (Roberts 2018). Places repeat after 1024.
inline vec2 spread_in_pixel(int i) {
  uint32_t n = uint32_t(i % 1024);
  auto part = [n](uint32_t step) { return float((0x80000000u + step * n) >> 8) * 0x1p-24f; };
  return {part(3242174889u), part(2447445414u)};
}

// Returns a step of about the golden ratio that, taken round and round, reaches each of `count`
// places once: neighbours in time lie far apart.
inline uint64_t golden_step(uint64_t count) {
  uint64_t step = std::max<uint64_t>(uint64_t(0.6180339887 * double(count)), 1);
  while (std::gcd(step, count) != 1) step++;
  return step;
}

}  // namespace wellspring
