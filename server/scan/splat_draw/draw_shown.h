// SPDX-License-Identifier: Apache-2.0
// Splats as they are drawn: eight side by side, in an octree's nodes, some of them merged. Made
// once for a set; about 150 bytes a splat at degree 3, and a third more for those that are merged.
// A node, or its children, are drawn by their size in the picture.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "base/simd.h"
#include "scan/splat_draw/splat_levels.h"
#include "scan/camera.h"

namespace wellspring::scan {

// Holds eight splats; those that fill up a node's last block have an opacity of 0.
struct SplatBlock {
  Lanes3 place;  // relative to ShownSplats::middle
  Lanes3 scale;
  Lanes turn_x, turn_y, turn_z, turn_w;
  Lanes opacity;
  // Codes of the colours times these are the colours, and the harmonics.
  float color_scale, harmonics_scale;
};

struct ShownSplats {
  int degree = 0;
  vec3 middle{0};                // the file's unit, as all that follows
  std::vector<SplatNode> nodes;  // their `first` is a block
  std::vector<SplatBlock> blocks;
  // Eight codes for each block, coefficient (the colour is the first) and channel.
  std::vector<int16_t> codes;

  int coefficients() const { return 1 + splat_harmonics[degree]; }
  std::span<const int16_t> block_codes(size_t block) const {
    const size_t count = size_t(coefficients()) * 3 * lane_count;
    return {codes.data() + block * count, count};
  }
};

ShownSplats make_shown_splats(const SplatSet& set);

// A set that stands somewhere: a place p of its file is at turn * (scale * p) + shift, metres.
struct PlacedSplats {
  const ShownSplats* splats = nullptr;
  quat turn{1, 0, 0, 0};
  double scale = 1;
  dvec3 shift{0};
  std::span<const ScanCut> cuts = {};  // in metres there; splats are cut by their middles
};

inline constexpr float nearest_splat = 0.1f;  // metres; nearer to the eye none is drawn

// A camera in the frame of a set's places (ShownSplats::middle is its origin), in the file's unit.
struct LocalView {
  vec3 eye, right, up, forward;
  float near;      // depth of the nearest splat
  float scale;     // metres of a unit
  float focal;     // pixels
  vec2 axis;       // pixel (i, j) lies at (i, j)
  glm::vec4 side;  // ratios of x, and of y, to depth at the left, right, top, bottom
  std::vector<ScanCut> cuts;
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
