// SPDX-License-Identifier: Apache-2.0
// Paints strokes of a brush: hashed over the picture, each with a direction of its own, so that any
// window sees the same ones. After Haeberli 1990 ("Paint by Numbers") and Hertzmann 1998 (strokes
// of several sizes).
#pragma once
#include <vector>

#include "store/painting/painting.h"

namespace wellspring::store {

// Holds what strokes do to each texel of a window. Rows are `stride` apart, a multiple of 8.
struct StrokeField {
  int width = 0, height = 0, stride = 0;
  std::vector<float> tone;              // share by which it is lighter
  std::vector<float> warmth;            // share by which it is warmer
  std::vector<float> relief;            // height of paint, in texels of the level
  std::vector<float> smear_x, smear_y;  // texels to where its colour is taken from
  void resize(int width, int height);
  size_t at(int x, int y) const { return size_t(y) * size_t(stride) + size_t(x); }
};

// Says where a field lies: `left` and `top` in texels of a level each of which is `texel` metres.
struct StrokeWindow {
  double left = 0, top = 0;
  double texel = 0.001;
  double picture = 1;  // width of the picture in metres
};

// Adds the strokes of all brushes, each to the texels that it painted: `brushes` has the number of
// each texel's (its rows are `width` long), as in PaintedVectors.
void add_strokes(StrokeField& field, const Painting& painting, const StrokeWindow& window,
                 const std::vector<uint8_t>& brushes);

// Returns how far strokes draw colours along, at most, in metres.
double longest_smear(const Painting& painting);

// Returns smooth noise from -1 to 1, which changes over a length of about 1.
float smooth_noise(uint64_t seed, double x, double y);

}  // namespace wellspring::store
