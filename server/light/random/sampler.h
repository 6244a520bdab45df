// SPDX-License-Identifier: Apache-2.0
// Draws a sample's random numbers: Sobol' points with hashed Owen scrambling (Burley 2020,
// "Practical Hash-based Owen Scrambling", sections 3 and 4), one or two dimensions at a time, each
// padded by its own shuffle of the indices. Samples of one seed are well spread over their first
// 2^k indices; samples of different seeds are independent; index 0 alone is uniformly random.
// Techniques draw through here only.
#pragma once
#include "base/rng.h"
#include "base/simd.h"
#include "base/vec.h"

namespace wellspring::light {

inline uint32_t reverse_bits(uint32_t x) {
  x = __builtin_bswap32(x);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}

// Applies a random permutation that flips each bit by a hash of the bits below it (Laine and Karras
// 2011, with the constants of Burley's section 3.1 as improved by Vegdahl 2021).
template <class Bits>  // one number or lanes of them
inline Bits permute_upwards(Bits x, Bits seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

// Reverses the bits of two numbers at once.
inline void reverse_bits(uint32_t& x, uint32_t& y) {
  uint64_t both = __builtin_bswap64(uint64_t(x) << 32 | y);
  both = ((both >> 4) & 0x0f0f0f0f0f0f0f0full) | ((both & 0x0f0f0f0f0f0f0f0full) << 4);
  both = ((both >> 2) & 0x3333333333333333ull) | ((both & 0x3333333333333333ull) << 2);
  both = ((both >> 1) & 0x5555555555555555ull) | ((both & 0x5555555555555555ull) << 1);
  x = uint32_t(both);
  y = uint32_t(both >> 32);
}

// Returns the second dimension of Sobol's sequence (generator x + 1), its bits reversed: the matrix
// is Pascal's triangle modulo 2, a Kronecker power, so that five steps apply it.
template <class Bits>
inline Bits sobol_second_reversed(Bits x) {
  x ^= x >> 16;
  x ^= (x >> 8) & 0x00ff00ffu;
  x ^= (x >> 4) & 0x0f0f0f0fu;
  x ^= (x >> 2) & 0x33333333u;
  return x ^ ((x >> 1) & 0x55555555u);
}

inline float unit_float(uint32_t bits) { return float(bits >> 8) * 0x1p-24f; }  // [0, 1)

// Draws one sample's numbers. Owen's nested scrambling flips each bit by a hash of the bits above
// it: it is permute_upwards of the reversed bits, reversed. Pairs of reversals are left out: the
// index is kept reversed, and so is its scrambling, which is its place in Sobol's first dimension.
struct Sampler {
  uint64_t seed = 0;
  uint32_t reversed_index = 0, drawn = 0;
  explicit Sampler(uint64_t seed, uint32_t index = 0)
      : seed(seed), reversed_index(reverse_bits(index)) {}
  // Sets the dimension of the next draw: whoever draws a varying count begins at fixed places, so
  // that samples of one seed stay well spread together in all later dimensions.
  void seek(uint32_t dimension) { drawn = dimension; }
  // Return one number, and two that are well spread together.
  float next() {
    uint64_t hash = mix64(seed + 0xd1b54a32d192ed03ull * ++drawn);
    uint32_t shuffled = reverse_bits(permute_upwards(reversed_index, uint32_t(hash)));
    return unit_float(reverse_bits(permute_upwards(shuffled, uint32_t(hash >> 32))));
  }
  vec2 next2() {
    uint64_t hash = mix64(seed + 0xd1b54a32d192ed03ull * ++drawn);
    uint32_t shuffled = reverse_bits(permute_upwards(reversed_index, uint32_t(hash)));
    uint32_t x = permute_upwards(shuffled, uint32_t(hash >> 32));
    uint32_t y = permute_upwards(sobol_second_reversed(shuffled), uint32_t(mix64(hash)));
    reverse_bits(x, y);
    return {unit_float(x), unit_float(y)};
  }
};

// Runs eight Samplers side by side: the same numbers, bit for bit.

inline LaneBits reverse_bits(LaneBits x) {
  x = (x >> 16) | (x << 16);
  x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}

inline Lanes unit_float(LaneBits bits) {
  return __builtin_convertvector(LaneMask(bits >> 8), Lanes) * 0x1p-24f;
}

struct SamplerLanes {
  uint64_t seed[lane_count] = {};
  LaneBits reversed_index{};

  void set(int lane, const Sampler& sampler) {
    seed[lane] = sampler.seed;
    reversed_index[lane] = sampler.reversed_index;
  }
  Sampler at(int lane) const {
    Sampler sampler(seed[lane]);
    sampler.reversed_index = reversed_index[lane];
    return sampler;
  }
  // Return what next() and next2() of each lane's Sampler return after seek(dimension of that
  // lane).
  Lanes number(LaneBits dimension) const {
    Hashes hashes = hash(dimension);
    LaneBits shuffled = reverse_bits(permute_upwards(reversed_index, hashes.low()));
    return unit_float(reverse_bits(permute_upwards(shuffled, hashes.high())));
  }
  void pair(LaneBits dimension, Lanes& x, Lanes& y) const {
    Hashes hashes = hash(dimension);
    LaneBits shuffled = reverse_bits(permute_upwards(reversed_index, hashes.low()));
    x = unit_float(reverse_bits(permute_upwards(shuffled, hashes.high())));
    for (uint64_t& of_lane : hashes.of) of_lane = mix64(of_lane);
    y = unit_float(reverse_bits(permute_upwards(sobol_second_reversed(shuffled), hashes.low())));
  }

 private:
  struct Hashes {
    uint64_t of[lane_count];
    LaneBits low() const {
      LaneBits bits;
      for (int i = 0; i < lane_count; i++) bits[i] = uint32_t(of[i]);
      return bits;
    }
    LaneBits high() const {
      LaneBits bits;
      for (int i = 0; i < lane_count; i++) bits[i] = uint32_t(of[i] >> 32);
      return bits;
    }
  };
  Hashes hash(LaneBits dimension) const {
    Hashes hashes;
    for (int i = 0; i < lane_count; i++)
      hashes.of[i] = mix64(seed[i] + 0xd1b54a32d192ed03ull * (dimension[i] + 1));
    return hashes;
  }
};

}  // namespace wellspring::light
