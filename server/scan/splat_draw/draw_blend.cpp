// SPDX-License-Identifier: Apache-2.0
#include "scan/splat_draw/draw_blend.h"

#include <algorithm>

#include "scan/splat_draw/draw_lanes.h"
#include "scan/splat_draw/draw_rows.h"

namespace wellspring::scan {
namespace {

constexpr int splats_a_check = 64;

template <bool behind_surface>
inline void blend_eight(SplatTile& pixels, int at, const SplatLanes& s, const RowOfSplat& row,
                        int x, const float* surface) {
  const Lanes across = lane_numbers + (float(x) - row.middle);
  const Lanes power = row.opacity - s.fall_x * (across * across);
  Lanes alpha = lanes_min(power_of_two(power), all_lanes(most_opacity));
  alpha = keep_lanes(alpha >= splat_threshold, alpha);
  Lanes nearness;
  if constexpr (behind_surface) {
    nearness = s.nearness_at(row, across);
    alpha = keep_lanes(nearness > load_lanes(surface + at), alpha);
  }
  const Lanes clear = load_lanes(&pixels.clear[at]);
  const Lanes weight = alpha * clear, rest = clear - weight;
  for (int c = 0; c < 3; c++)
    store_lanes(&pixels.color[c][at], load_lanes(&pixels.color[c][at]) + weight * s.color[c]);
  store_lanes(&pixels.clear[at], rest);
  const LaneMask half = (clear > 0.5f) & (rest <= 0.5f);
  if (any_lane(half)) {
    if constexpr (!behind_surface) nearness = s.nearness_at(row, across);
    store_lanes(&pixels.nearness[at], half ? nearness : load_lanes(&pixels.nearness[at]));
  }
}

template <bool behind_surface>
bool blend_list(SplatTile& pixels, const DrawnSplats& drawn, std::span<const uint32_t> list,
                const SplatTilePlace& place) {
  RowLimits open;
  SplatRows rows;
  for (size_t i = 0; i < list.size(); i++) {
    if (i % splats_a_check == 0 && find_open(open, pixels, splat_threshold)) return true;
    if (i + 12 < list.size()) __builtin_prefetch(&drawn.splats[list[i + 12]]);
    const DrawnSplat& splat = drawn.splats[list[i]];
    const SplatLanes lanes(splat);
    const int left = std::max(splat.box.left - place.x, 0),
              right = std::min(splat.box.right - place.x, tile_width - 1);
    if (right - left < lane_count) {
      // Most splats are so narrow that eight pixels hold any of their rows.
      const int end = std::min(splat.box.bottom - place.y + 1, tile_height);
      for (int r = std::max(splat.box.top - place.y, 0); r < end; r++) {
        const float down = float(r + place.y) - splat.y;
        const RowOfSplat row{splat.x - float(place.x) + splat.lean * down,
                             splat.opacity - splat.fall_y * down * down, down, left, right};
        blend_eight<behind_surface>(pixels, r * tile_stride + left, lanes, row, left,
                                    place.surface);
      }
      continue;
    }
    rows.find(splat, place.x, place.y, open);
    for (int r = rows.begin; r < rows.end; r++) {
      const RowOfSplat row = rows.row(r);
      for (int x = row.first; x <= row.last; x += lane_count)
        blend_eight<behind_surface>(pixels, r * tile_stride + x, lanes, row, x, place.surface);
    }
  }
  return find_open(open, pixels, splat_threshold);
}

}  // namespace

bool blend_in_order(SplatTile& pixels, const DrawnSplats& drawn, std::span<const uint32_t> list,
                    const SplatTilePlace& place) {
  return place.surface != nullptr ? blend_list<true>(pixels, drawn, list, place)
                                  : blend_list<false>(pixels, drawn, list, place);
}

}  // namespace wellspring::scan
