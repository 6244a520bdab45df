// SPDX-License-Identifier: Apache-2.0
// Draws a painting's items into a window of one of its levels, by Cairo. Items too small to be seen
// there are left out or stand for themselves with their mean colour, so a window costs about the
// same at every level. The work of a window is bounded: what is beyond that is left out.
#pragma once
#include <vector>

#include "store/painting/painting.h"

namespace wellspring::store {

// Says which texels of a level are drawn: `scale` is the level's whole width in texels.
struct PaintWindow {
  double left = 0, top = 0, scale = 1;
  int width = 1, height = 1;
};

// Holds a window as Cairo has it: premultiplied ARGB of 32 bits; and which brush painted a texel,
// 0: none, else its number and one.
struct PaintedVectors {
  int width = 0, height = 0;
  std::vector<uint32_t> colors;
  std::vector<uint8_t> brushes;
  bool crowded = false;  // something was left out: it was too much work
};

PaintedVectors draw_vectors(const Painting& painting, const PaintLayer& layer,
                            const PaintWindow& window);

// Returns the mean of an item's colours over a box in the space of what holds it.
PaintColor mean_color(const Painting& painting, const PaintItem& item, const PaintBox& box);

}  // namespace wellspring::store
