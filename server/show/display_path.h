// SPDX-License-Identifier: Apache-2.0
// What a picture's time is spent on, decided by what was measured. Path `cache`: nearly all goes to
// samples, a little to looks at edges (cache/looks.h). Path `primary`: shape and reflectance of
// every pixel are exact, drawn (cache/compose_drawn.h) while that leaves time for light, or with
// every pixel looked at where even that does: a quick machine, a small picture, few visitors.
// Drawing may slow pictures down, but not below two a second: a few points alone are no picture at
// all.
#pragma once
#include <cstddef>
#include <cstdint>

namespace wellspring {

struct DisplayCosts {
  double samples_per_second = 0, looks_per_second = 0;  // all cores
  double drawing_seconds = 0;  // of a picture, all cores; 0: never measured
  double display_seconds =
      0;  // what a picture takes besides: reprojection, composing, tone mapping
  double light_seconds = 0;    // the same of one drawn for who moves; 0: never measured
};

enum class DrawShapes : uint8_t { automatic, never, always };  // server option --draw

struct DisplayPlan {
  bool drawn = false;    // shapes and reflectances are (cache/compose_drawn.h)
  bool primary = false;  // every pixel is looked at
  int samples = 0, looks = 0;
};

// `seconds`: what there is for all. `before`: of the picture before, which is kept until another
// way is clearly better, so that paths do not alternate. `fine`: see wants_fine_light(); then at
// least a quarter of a drawn picture's time goes to light.
DisplayPlan plan_display(double seconds, size_t pixels, const DisplayCosts& costs,
                         const DisplayPlan& before, bool fine = false,
                         DrawShapes wish = DrawShapes::automatic);

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
