// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "scan/splat_draw/draw_blend.h"
#include "scan/splat_draw/draw_rows.h"

namespace wellspring::scan {
namespace {

constexpr int splats_a_turn = 64, most_held = 512;
constexpr float closed_pixel = 1e-4f;  // as the reference's program

// A splat that a pixel holds back until no nearer one can come.
struct HeldSplat {
  float nearness, alpha;
  uint32_t place;  // in the tile's list
  bool operator<(const HeldSplat& other) const {
    return nearness != other.nearness ? nearness > other.nearness : place < other.place;
  }
};

struct HeldPixels {
  std::array<uint16_t, tile_width * tile_height> count{};
  std::vector<HeldSplat> splats = std::vector<HeldSplat>(count.size() * most_held);
  std::span<HeldSplat> of(size_t pixel) {
    return std::span(splats).subspan(pixel * most_held, count[pixel]);
  }
};

void blend_held(SplatTile& pixels, size_t at, const HeldSplat& held, vec3 color) {
  float& clear = pixels.clear[at];
  if (clear < closed_pixel) return;
  const float weight = held.alpha * clear, rest = clear - weight;
  for (int c = 0; c < 3; c++) pixels.color[c][at] += weight * color[c];
  if (clear > 0.5f && rest <= 0.5f) pixels.nearness[at] = held.nearness;
  clear = rest;
}

class PixelOrder {
 public:
  PixelOrder(SplatTile& pixels, HeldPixels& held, const DrawnSplats& drawn,
             std::span<const uint32_t> list)
      : pixels_(pixels), held_(held), drawn_(drawn), list_(list) {}

  void hold(size_t pixel, const HeldSplat& splat) {
    if (held_.count[pixel] == most_held) {
      const auto all = held_.of(pixel);
      std::nth_element(all.begin(), all.begin() + most_held / 2, all.end());
      blend(pixel, all[most_held / 2].nearness);
    }
    held_.splats[pixel * most_held + held_.count[pixel]++] = splat;
  }
  // Blends what is at least so near.
  void blend(size_t pixel, float nearness) {
    const auto all = held_.of(pixel);
    const auto end = std::partition(all.begin(), all.end(),
                                    [&](const HeldSplat& s) { return s.nearness >= nearness; });
    std::sort(all.begin(), end);
    const size_t at = pixel / tile_width * tile_stride + pixel % tile_width;
    for (auto s = all.begin(); s != end; ++s)
      blend_held(pixels_, at, *s, drawn_.splats[list_[s->place]].color);
    std::move(end, all.end(), all.begin());
    held_.count[pixel] = uint16_t(all.end() - end);
  }
  void blend_all(float nearness) {
    for (size_t pixel = 0; pixel < held_.count.size(); pixel++)
      if (held_.count[pixel] != 0) blend(pixel, nearness);
  }

 private:
  SplatTile& pixels_;
  HeldPixels& held_;
  const DrawnSplats& drawn_;
  const std::span<const uint32_t> list_;
};

}  // namespace

void blend_by_pixel(SplatTile& pixels, const DrawnSplats& drawn, std::span<const uint32_t> list,
                    const SplatTilePlace& place) {
  thread_local std::unique_ptr<HeldPixels> room;
  if (!room) room = std::make_unique<HeldPixels>();
  PixelOrder order(pixels, *room, drawn, list);
  RowLimits open;
  SplatRows rows;
  bool closed = false;
  for (size_t i = 0; i < list.size() && !closed; i++) {
    const DrawnSplat& splat = drawn.splats[list[i]];
    if (i % splats_a_turn == 0) {
      order.blend_all(splat.nearest);
      closed = find_open(open, pixels, closed_pixel);
    }
    const SplatLanes lanes(splat);
    rows.find(splat, place.x, place.y, open);
    for (int r = rows.begin; r < rows.end; r++) {
      const RowOfSplat row = rows.row(r);
      for (int x = row.first; x <= row.last; x += lane_count) {
        const Lanes across = lane_numbers + (float(x) - row.middle);
        const Lanes power = row.opacity - lanes.fall_x * (across * across);
        const Lanes alpha = lanes_min(power_of_two(power), all_lanes(most_opacity));
        const Lanes nearness = lanes.nearness_at(row, across);
        LaneMask seen = alpha >= splat_threshold;
        if (place.surface != nullptr)
          seen &= nearness > load_lanes(place.surface + r * tile_stride + x);
        unsigned bits = negative_lanes(seen);
        if (x + lane_count > tile_width) bits &= (1u << (tile_width - x)) - 1;
        for (; bits != 0; bits &= bits - 1) {
          const int lane = std::countr_zero(bits);
          order.hold(size_t(r * tile_width + x + lane), {nearness[lane], alpha[lane], uint32_t(i)});
        }
      }
    }
  }
  order.blend_all(0);
  room->count.fill(0);
}

}  // namespace wellspring::scan
