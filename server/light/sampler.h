// SPDX-License-Identifier: Apache-2.0
// Where a sample's random numbers come from: Sobol' points with hashed Owen scrambling (Burley 2020,
// "Practical Hash-based Owen Scrambling", sections 3 and 4), one or two dimensions at a time, each
// padded by its own shuffle of the indices. Samples of one seed are well spread over their first
// 2^k indices; samples of different seeds are independent; index 0 alone is uniformly random.
// Techniques draw through here only.
#pragma once
#include "base/rng.h"
#include "base/vec.h"

namespace wellspring {

inline uint32_t reverse_bits(uint32_t x) {
  x = __builtin_bswap32(x);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}

// A random permutation that flips each bit by a hash of the bits below it (Laine and Karras 2011,
// with the constants of Burley's section 3.1 as improved by Vegdahl 2021).
inline uint32_t permute_upwards(uint32_t x, uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

// Owen's nested scrambling: flips each bit by a hash of the bits above it.
inline uint32_t owen_scramble(uint32_t x, uint32_t seed) {
  return reverse_bits(permute_upwards(reverse_bits(x), seed));
}

// Second dimension of Sobol's sequence (generator x + 1), whose matrix is Pascal's triangle modulo 2:
// a Kronecker power, so that five steps apply it.
inline uint32_t sobol_second(uint32_t index) {
  uint32_t x = reverse_bits(index);
  x ^= (x & 0x0000ffffu) << 16;
  x ^= (x & 0x00ff00ffu) << 8;
  x ^= (x & 0x0f0f0f0fu) << 4;
  x ^= (x & 0x33333333u) << 2;
  x ^= (x & 0x55555555u) << 1;
  return x;
}

inline float unit_float(uint32_t bits) { return float(bits >> 8) * 0x1p-24f; }  // [0, 1)

struct Sampler {
  uint64_t seed = 0;
  uint32_t index = 0, drawn = 0;
  explicit Sampler(uint64_t seed, uint32_t index = 0) : seed(seed), index(index) {}
  // The next draw is this dimension's: whoever draws a varying count begins at fixed places, so that
  // samples of one seed stay well spread together in all later dimensions.
  void seek(uint32_t dimension) { drawn = dimension; }
  // One number, and two that are well spread together.
  float next() {
    uint64_t hash = mix64(seed + 0xd1b54a32d192ed03ull * ++drawn);
    uint32_t shuffled = permute_upwards(reverse_bits(index), uint32_t(hash));  // reversed
    return unit_float(owen_scramble(shuffled, uint32_t(hash >> 32)));
  }
  vec2 next2() {
    uint64_t hash = mix64(seed + 0xd1b54a32d192ed03ull * ++drawn), more = mix64(hash);
    uint32_t shuffled = owen_scramble(index, uint32_t(hash));
    return {unit_float(owen_scramble(reverse_bits(shuffled), uint32_t(hash >> 32))),
            unit_float(owen_scramble(sobol_second(shuffled), uint32_t(more)))};
  }
};

}  // namespace wellspring
