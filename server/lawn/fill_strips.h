// SPDX-License-Identifier: Apache-2.0
// Fills pieces of strips into a part of a picture that fits into the processor's cache: eight rows
// at a time, or eight columns of pieces that rather lie; each pixel's values are one vector.
#pragma once
#include <array>
#include <span>

#include "base/simd.h"
#include "base/vec.h"

namespace wellspring::lawn {

inline constexpr int bin_width = 64, bin_height = 32;  // pixels

struct BinPixels {
  int x = 0, y = 0, width = 0, height = 0;  // its part of the picture
  float near = 0;
  vec2 offset{0.5f};
  bool coverage = false;  // false: pixels are covered or not
  std::array<float, bin_width * bin_height> depth, covered;
  std::array<float, bin_width * bin_height> limit;  // nothing is seen behind
  std::array<Lanes, bin_width * bin_height> value;  // times `covered`

  // `before` is a whole picture of that width, or empty.
  void clear(std::span<const float> before, int picture_width);
};

// A quadrilateral between two joints: their places in the picture, half of the way across, inverse
// depths.
struct StripPart {
  vec2 place[2], half[2];
  float inverse[2];
};

// `value` belongs to the first joint's middle, `along` is the change to the second, `aside` that to
// the edge to which `half` points.
void fill_part(BinPixels& pixels, const StripPart& part, const Lanes& value, const Lanes& along,
               const Lanes& aside);

}  // namespace wellspring::lawn
