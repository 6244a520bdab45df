// SPDX-License-Identifier: Apache-2.0
// Draws the discs of one tile of the picture.
#pragma once
#include <span>
#include <vector>

#include "base/simd.h"
#include "scan/draw/disc.h"
#include "scan/draw/point_buffer.h"

namespace wellspring::scan {

// Borrows, for one picture, what all tiles read.
struct DiscScene {
  std::span<const NodePoints> nodes;
  std::span<const Piece> pieces;
  const ScanCamera* view = nullptr;
  bool blended = false;
  bool spheres = false;
};

// The planes of a tile: rows of tile_side pixels, and what eight pixels at a time may read and
// write beyond them. A thread uses them for one tile after the other.
struct TilePlanes {
  static constexpr int stride = tile_side + lane_count;
  static constexpr int size = (tile_side + 1) * stride + lane_count;
  // The least key is seen; it is the depth plus what lets the nearest middle win.
  std::vector<float> key, depth;
  std::vector<uint32_t> point;
  // Sums of weight times red, green, blue (linear), intensity, normal (x, y, z), 1.
  std::vector<Lanes> sum;
};

// Draws runs of discs, the earlier ones before later ones at the same depth, and writes the tile's
// pixels of `buffer`. `area` is the sum of the runs' areas.
// `large`: spheres that the tile may show and that are in no run.
void draw_disc_tile(PointBuffer& buffer, TilePlanes& planes, const DiscScene& scene, int tile_x,
                    int tile_y, std::span<const std::span<const Disc>> runs, uint64_t area,
                    std::span<const Disc> large);

}  // namespace wellspring::scan
