// SPDX-License-Identifier: Apache-2.0
// How many samples a picture is given, and how fine its light is, decided by what was measured.
#pragma once
#include <cstddef>

namespace wellspring {

struct DrawingCosts {
  double samples_per_second = 0;  // all cores
  double drawing_seconds = 0;     // visibility and shading of a picture, all cores
  double display_seconds = 0;     // what a picture takes besides: reprojection, tone mapping
  double light_seconds = 0;  // the same of one drawn for who moves; 0: never measured
};

// `seconds`: what there is for all. `fine`: see wants_fine_light(); then at least a quarter of a
// picture's time goes to light.
int sample_budget(double seconds, size_t pixels, const DrawingCosts& costs, bool fine);

// Light of the picture's own resolution, for who stands, once there are samples enough: below some
// 0.35 a pixel light of half of it has less error (castle, the storyteller: FLIP 0.193 after 0.213
// at a tenth). `coarse`, `guessed`: of the picture before, and the share of its light that no point
// told.
bool wants_fine_light(bool stands, bool coarse, float guessed);

// The same for who moves: `samples` of light a second for each pixel. `before`: it was in the
// picture before.
bool affords_fine_light(double samples, bool before);

// Whether the reference (`path`) answers: who has stood for a while, when most places have so many
// answers of the quicker technique, whose single samples tell more, that those of the reference are
// no noise to speak of. `before`: it did for the picture before. `known`: share of the pixels with
// that many (CacheStats::converged).
bool wants_reference(double seconds_at_rest, bool before, bool coarse, float guessed, float known);

}  // namespace wellspring
