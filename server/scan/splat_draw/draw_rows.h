// SPDX-License-Identifier: Apache-2.0
// Finds which pixels of a tile's rows a splat covers, eight rows at a time.
#pragma once
#include <algorithm>
#include <bit>

#include "scan/splat_draw/draw_lanes.h"
#include "scan/splat_draw/draw_tiles.h"

namespace wellspring::scan {

// Pixels of the tile's rows that are worth looking at.
struct RowLimits {
  float first[tile_height], last[tile_height];
};

// Finds the pixels through which at least `threshold` of the light comes; returns whether there are
// none.
inline bool find_open(RowLimits& open, const SplatTile& pixels, float threshold) {
  bool none = true;
  for (int row = 0; row < tile_height; row++) {
    int first = tile_width, last = -1;
    for (int x = 0; x < tile_width; x += lane_count) {
      const Lanes clear = load_lanes(&pixels.clear[row * tile_stride + x]);
      const unsigned bits = negative_lanes(clear >= threshold);
      if (bits == 0) continue;
      first = std::min(first, x + std::countr_zero(bits));
      last = x + 31 - std::countl_zero(bits);
      none = false;
    }
    open.first[row] = float(first), open.last[row] = float(last);
  }
  return none;
}

struct RowOfSplat {
  float middle;   // x in the tile, the splat is widest there
  float opacity;  // logarithm there, to base 2
  float down;     // rows from the splat's middle
  int first, last;
};

// The rows `begin` to before `end` of a tile that a splat covers.
class SplatRows {
 public:
  int begin = 0, end = 0;

  // `x`, `y`: the tile's first pixel.
  [[gnu::always_inline]] void find(const DrawnSplat& s, int x, int y, const RowLimits& limits) {
    begin = std::max(s.box.top - y, 0);
    end = std::min(s.box.bottom - y + 1, tile_height);
    const float reach = s.opacity - log_threshold;
    const Lanes fall_y = all_lanes(s.fall_y), inverse = all_lanes(1 / s.fall_x);
    for (int row = begin; row < end; row += lane_count) {
      const int from = std::min(row, tile_height - lane_count);
      const Lanes down = lane_numbers + (float(y + from) - s.y);
      const Lanes fall = fall_y * (down * down);
      const Lanes half = lanes_sqrt(positive_lanes(reach - fall) * inverse);
      const Lanes middle = down * s.lean + (s.x - float(x));
      const Lanes first = lanes_max(middle - half + 0.9999f, load_lanes(limits.first + from));
      const Lanes last = lanes_min(middle + half, load_lanes(limits.last + from));
      // Cut off towards 0, to the left of the tile, too: no pixel there is after `first`.
      store_lanes(middle_ + from, middle);
      store_lanes(opacity_ + from, s.opacity - fall);
      store_lanes(down_ + from, down);
      store_lanes(first_ + from, to_whole(lanes_min(first, all_lanes(tile_width))));
      store_lanes(last_ + from, to_whole(lanes_max(last, all_lanes(-1)) + 1) - 1);
    }
  }
  RowOfSplat row(int r) const { return {middle_[r], opacity_[r], down_[r], first_[r], last_[r]}; }

 private:
  float middle_[tile_height], opacity_[tile_height], down_[tile_height];
  int32_t first_[tile_height], last_[tile_height];
};

// Keeps what lanes need to know about a splat.
struct SplatLanes {
  float fall_x;
  vec3 color;
  float nearness, slope_x, slope_y, farthest, nearest;
  explicit SplatLanes(const DrawnSplat& s)
      : fall_x(s.fall_x),
        color(s.color),
        nearness(s.nearness),
        slope_x(s.slope_x),
        slope_y(s.slope_y),
        farthest(s.farthest),
        nearest(s.nearest) {}
  // `across`: pixels from the row's middle.
  Lanes nearness_at(const RowOfSplat& row, const Lanes& across) const {
    const Lanes at = across * slope_x + (nearness + slope_y * row.down);
    return lanes_min(lanes_max(at, all_lanes(farthest)), all_lanes(nearest));
  }
};

}  // namespace wellspring::scan
