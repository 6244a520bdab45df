// SPDX-License-Identifier: Apache-2.0
// Fills strips into a part of a picture that fits into the processor's cache: eight rows at a time,
// or eight columns of pieces that rather lie; each pixel's values are one vector.
#pragma once
#include <array>
#include <span>

#include "base/simd.h"
#include "base/vec.h"
#include "lawn/lawn.h"

namespace wellspring::lawn {

inline constexpr int bin_width = 64, bin_height = 64;  // pixels

// Holds a blade in the picture, by its joints: places in pixels, half of the way from edge to edge,
// inverse depths.
struct Strip {
  float x[joints], y[joints], inverse[joints], half_x[joints], half_y[joints];
  float unused[4];
  // Normal, colour, share of the height and sway at joints; and what they change by from
  // the middle to the edge to which `half_x` and `half_y` lead.
  Lanes value[joints], aside;
};

struct BinPixels {
  int x = 0, y = 0, width = 0, height = 0;  // its part of the picture
  float near = 0;
  vec2 offset{0.5f};
  bool coverage = false;    // false: pixels are covered or not
  bool is_limited = false;  // `limit` is used
  std::array<float, bin_width * bin_height> depth, covered;
  std::array<float, bin_width * bin_height> limit;  // nothing is seen behind
  std::array<Lanes, bin_width * bin_height> value;  // times `covered`; nothing where that is 0

  // `before` is a whole picture of that width, or empty.
  void clear(std::span<const float> before, int picture_width);
};

void fill_strip(BinPixels& pixels, const Strip& strip);

}  // namespace wellspring::lawn
