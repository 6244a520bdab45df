// SPDX-License-Identifier: Apache-2.0
// The points of one node of a tree of points, where they lie in a mapped file.
#pragma once
#include <cstdint>

#include "base/vec.h"

namespace wellspring::scan {

inline constexpr float own_spacing_steps = 32;

// A node holds all points of its cube (a leaf), or fewer that stand for them: each is the mean of
// its neighbourhood in colour and normal. So a picture shows a node or its children, never both.
// Columns are borrowed, `count` long, and may be read, not trusted, up to 8 items beyond.
struct NodePoints {
  // Metres in the tree's frame, +Y up, relative to PointTree::origin: doubles, since a leaf far
  // from the origin still tells half millimetres apart.
  dvec3 corner{0};    // the cube's lowest
  float size = 0;     // the cube's edge
  float spacing = 0;  // typical distance of a point from its neighbours on the surface
  uint32_t count = 0;
  // Place: corner + (x + 0.5) * size / 65536.
  const uint16_t *x = nullptr, *y = nullptr, *z = nullptr;
  const uint32_t* color = nullptr;  // sRGB, red in the lowest byte; intensity in the highest one
  // Octahedral (Meyer et al. 2010): signed bytes u, v times 127, u in the lower one; 0x8080: the
  // point has no normal.
  const uint16_t* normal = nullptr;
  // A point's own spacing, in 1/own_spacing_steps of the node's, at most 255; null: it is as the
  // node's.
  const uint8_t* own_spacing = nullptr;
  const uint8_t* classification = nullptr;  // null: the scan has none
};

}  // namespace wellspring::scan
