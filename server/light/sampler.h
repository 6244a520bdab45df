// SPDX-License-Identifier: Apache-2.0
// Where a sample's random numbers come from: one stream per Request::seed, drawn in order, so that
// a sample is a function of its ray and seed alone. Techniques draw through here only.
#pragma once
#include "base/rng.h"
#include "base/vec.h"

namespace wellspring {

struct Sampler {
  Rng rng;
  explicit Sampler(uint64_t seed) : rng(seed) {}
  float next() { return rng.uniform(); }
  vec2 next2() {
    float first = rng.uniform();
    return {first, rng.uniform()};
  }
};

}  // namespace wellspring
