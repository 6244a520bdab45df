// SPDX-License-Identifier: Apache-2.0
// Chooses the nodes of sets of splats that are drawn: a node, or its children, by their size in the
// picture.
#pragma once
#include <span>
#include <vector>

#include "scan/splat_draw/draw_shown.h"
#include "scan/camera.h"

namespace wellspring::scan {

// A camera in the frame of a set's places (ShownSplats::middle is its origin), in the file's unit.
struct LocalView {
  vec3 eye, right, up, forward;
  float near;      // depth of the nearest splat
  float scale;     // metres of a unit
  float focal;     // pixels
  vec2 axis;       // pixel (i, j) lies at (i, j)
  glm::vec4 side;  // ratios of x, and of y, to depth at the left, right, top, bottom
};

LocalView make_local_view(const PlacedSplats& set, const ScanCamera& view);

struct ChosenSplats {
  uint32_t set, node;
};

// Nodes that are not in the picture are left out. Cells of those that are chosen are at most
// `cell_pixels` large, unless more than `budget` splats would be drawn: then the largest cells are
// as small as can be.
std::vector<ChosenSplats> choose_splats(std::span<const PlacedSplats> sets,
                                        std::span<const LocalView> views, float cell_pixels,
                                        int64_t budget);

}  // namespace wellspring::scan
