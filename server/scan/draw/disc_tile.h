// SPDX-License-Identifier: Apache-2.0
// Draws the discs of one tile of the picture.
#pragma once
#include <span>
#include <vector>

#include "base/simd.h"
#include "scan/draw/disc.h"
#include "scan/draw/draw_points.h"

namespace wellspring::scan {

// Borrows, for one picture, what all tiles read.
struct DiscScene {
  std::span<const NodePoints> nodes;
  std::span<const Piece> pieces;
  const PointView* view = nullptr;
  bool blended = false;
};

// A thread's planes of a tile, used for one tile after the other.
class DiscTile {
 public:
  // Draws runs of discs, the earlier ones before later ones at the same depth, and writes the
  // tile's pixels of `buffer`. `area` is the sum of the runs' areas.
  void draw(PointBuffer& buffer, const DiscScene& scene, int tile_x, int tile_y,
            std::span<const std::span<const Disc>> runs, uint64_t area);

 private:
  // Where the tile is and how its discs are changed.
  struct Place {
    int left = 0, top = 0;  // pixels
    float shrink = 1;       // discs' radii are times this
    float pixel = 1;        // metres of a pixel at a depth of 1
    float near = 0;         // metres
  };
  static constexpr int stride = tile_side + lane_count;
  static constexpr int size = (tile_side + 1) * stride + lane_count;
  void place_disc(const Disc& disc, const Place& place);
  void blend_disc(const Disc& disc, const Place& place, const Lanes& value);
  void write(PointBuffer& buffer, const DiscScene& scene, const Place& place);
  void write_mean(PointBuffer& buffer, const DiscScene& scene, const Place& place);

  // The least key is seen; it is the depth plus what lets the nearest middle win.
  std::vector<float> key_, depth_;
  std::vector<uint32_t> point_;
  // Sums of weight times red, green, blue (linear), intensity, normal (x, y, z), 1.
  std::vector<Lanes> sum_;
};

}  // namespace wellspring::scan
