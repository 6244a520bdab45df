// SPDX-License-Identifier: Apache-2.0
// Where on a triangle its picture emits light: the triangle cut into n * n equal ones by its
// barycentric weights, each with its chance by mean brightness. Made only where the picture varies
// enough over the triangle to pay for the look-up.
#pragma once
#include <functional>

#include "base/vec.h"
#include "light/random/alias_table.h"

namespace wellspring::light {

struct EmissionPicture {
  int n = 0;
  AliasTable cells;  // empty: brightness varies too little
};

inline constexpr int most_emission_rows = 64;

// `eval(barycentric)`: luminance there, weights of the second and third corner. `texels`: of the
// picture on the triangle, as many as matter. Every cell keeps a chance, since a few look-ups may
// miss a bright texel.
EmissionPicture make_emission_picture(float texels, const std::function<float(vec2)>& eval);

struct PicturePlace {
  vec2 barycentric{0};
  float density = 0;  // over the triangle, its area taken as 1
};
PicturePlace sample_emission_picture(const EmissionPicture& picture, vec2 u);
float sample_emission_picture_pdf(const EmissionPicture& picture, vec2 barycentric);

}  // namespace wellspring::light
