// SPDX-License-Identifier: Apache-2.0
// Eight Samplers side by side: the same numbers, bit for bit.
#pragma once
#include "base/simd.h"
#include "light/random/sampler.h"

namespace wellspring::light {

inline LaneBits reverse_bits(LaneBits x) {
  x = (x >> 16) | (x << 16);
  x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}

inline LaneBits sobol_second_reversed(LaneBits x) {
  x ^= x >> 16;
  x ^= (x >> 8) & 0x00ff00ffu;
  x ^= (x >> 4) & 0x0f0f0f0fu;
  x ^= (x >> 2) & 0x33333333u;
  return x ^ ((x >> 1) & 0x55555555u);
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
  // What next() and next2() of each lane's Sampler return after seek(dimension of that lane).
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
