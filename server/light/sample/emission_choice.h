// SPDX-License-Identifier: Apache-2.0
// Which source a ray of light leaves (light/sample/emission.h), chosen by power.
#pragma once
#include "base/vec.h"
#include "light/random/alias_table.h"

namespace wellspring::light {

// Sources are numbered: emitting triangles, then punctual lights, then the environment.
struct EmissionChoice {
  AliasTable rays;  // all of them, by power
  AliasTable
      places;  // those that light only a share of a picture's pixels each: see exact_punctual
  AliasTable caustics;         // sources of photons: without a sky that is the same all over
  bool exact_punctual = true;  // few punctual lights: every pixel asks each of them
  vec3 centre{0};              // of a sphere around the scene
  float radius = 1;
};
inline constexpr size_t most_exact_punctual = 4;

}  // namespace wellspring::light
