// SPDX-License-Identifier: Apache-2.0
#include "scan/splat_draw/draw_tiles.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "base/parallel.h"

namespace wellspring::scan {
namespace {

constexpr int digit_bits = 11, digits = 1 << digit_bits;
constexpr size_t keys_a_part = 1 << 15;

// Sorts by one digit. Parts of the keys count their digits, so each knows where its keys go.
void sort_by_digit(std::vector<DrawnKey>& to, const std::vector<DrawnKey>& from, int shift) {
  const size_t parts = (from.size() + keys_a_part - 1) / keys_a_part;
  std::vector<std::array<uint32_t, digits>> places(parts);
  const auto each_key = [&](int part, const auto& body) {
    const size_t begin = size_t(part) * keys_a_part;
    const size_t end = std::min(from.size(), begin + keys_a_part);
    for (size_t i = begin; i < end; i++)
      body(from[i], places[size_t(part)][from[i].depth >> shift & (digits - 1)]);
  };
  parallel_each(int(parts), [&](int part) {
    places[size_t(part)].fill(0);
    each_key(part, [](const DrawnKey&, uint32_t& place) { place++; });
  });
  uint32_t sum = 0;
  for (int digit = 0; digit < digits; digit++)
    for (auto& part : places) sum += std::exchange(part[size_t(digit)], sum);
  parallel_each(int(parts), [&](int part) {
    each_key(part, [&](const DrawnKey& key, uint32_t& place) { to[place++] = key; });
  });
}

// Half of an ellipse's width `down` rows below its middle, and how far it reaches.
struct Ellipse {
  float reach, half_height, widest;  // `widest`: the row of its rightmost place
  explicit Ellipse(const DrawnSplat& s) : reach(s.opacity - log_threshold) {
    const float yy = 1 / s.fall_y, xx = 1 / s.fall_x + s.lean * s.lean * yy;
    half_height = std::sqrt(reach * yy);
    widest = s.lean * yy * std::sqrt(reach / xx);
  }
  float side(const DrawnSplat& s, float down, float sign) const {
    const float rest = reach - s.fall_y * down * down;
    return s.x + s.lean * down + sign * std::sqrt(std::max(rest, 0.0f) / s.fall_x);
  }
};

// Calls body(tile) for all tiles that the splat touches, row by row.
template <class Body>
inline void each_tile(const DrawnSplat& s, const PixelBox& box, const SplatGrid& grid,
                      int first_row, int last_row, const Body& body) {
  const int left = box.left / tile_width, right = box.right / tile_width,
            top = std::max(box.top / tile_height, first_row),
            bottom = std::min(box.bottom / tile_height, last_row - 1);
  // To look at a splat costs more than a corner's tile too many.
  if ((right - left + 1) * (bottom - top + 1) <= 4) {
    for (int row = top; row <= bottom; row++)
      for (int column = left; column <= right; column++) body(row * grid.across + column);
    return;
  }
  const Ellipse ellipse(s);
  for (int row = top; row <= bottom; row++) {
    const float above = std::max(float(row * tile_height) - s.y, -ellipse.half_height);
    const float below =
        std::min(float(row * tile_height + tile_height - 1) - s.y, ellipse.half_height);
    const float low =
        ellipse.side(s, std::clamp(-ellipse.widest, above, std::max(above, below)), -1);
    const float high =
        ellipse.side(s, std::clamp(ellipse.widest, above, std::max(above, below)), 1);
    const int begin = std::max(left, int(std::max(low, 0.0f)) / tile_width);
    const int end = std::min(right, int(std::min(high, 32767.0f)) / tile_width);
    for (int column = begin; column <= end; column++) body(row * grid.across + column);
  }
}

}  // namespace

void sort_by_depth(std::vector<DrawnKey>& keys, std::vector<DrawnKey>& spare) {
  uint32_t low = ~0u, high = 0;
  for (const DrawnKey& key : keys) low = std::min(low, key.depth), high = std::max(high, key.depth);
  if (low >= high) return;
  const int shift = std::max(0, int(std::bit_width(high - low)) - 2 * digit_bits);
  for (DrawnKey& key : keys) key.depth = (key.depth - low) >> shift;
  spare.resize(keys.size());
  sort_by_digit(spare, keys, 0);
  sort_by_digit(keys, spare, digit_bits);
}

void list_splats(SplatLists& lists, const DrawnSplats& drawn, std::span<const DrawnKey> keys,
                 std::span<const PixelBox> boxes, const SplatGrid& grid,
                 std::span<const float> limits, int first_row, int last_row) {
  const size_t tiles = size_t(grid.count());
  const size_t a_part = std::max<size_t>(4096, (keys.size() + 15) / 16);
  const size_t parts = (keys.size() + a_part - 1) / a_part;
  std::vector<uint32_t> places(parts * tiles);
  const auto each_entry = [&](int part, const auto& body) {
    uint32_t* const own = places.data() + size_t(part) * tiles;
    const size_t begin = size_t(part) * a_part, end = std::min(keys.size(), begin + a_part);
    for (size_t i = begin; i < end; i++) {
      const uint32_t number = keys[i].number;
      each_tile(drawn.splats[number], boxes[i], grid, first_row, last_row, [&](int tile) {
        const float limit = limits[size_t(tile)];
        if (limit > 0 && (limit == std::numeric_limits<float>::infinity() ||
                          drawn.splats[number].nearest < limit))
          return;
        body(own[tile], number);
      });
    }
  };
  parallel_each(int(parts),
                [&](int part) { each_entry(part, [](uint32_t& place, uint32_t) { place++; }); });
  uint32_t sum = 0;
  lists.first.resize(tiles + 1);
  for (size_t tile = 0; tile < tiles; tile++) {
    lists.first[tile] = sum;
    for (size_t part = 0; part < parts; part++)
      sum += std::exchange(places[part * tiles + tile], sum);
  }
  lists.first[tiles] = sum;
  if (lists.splats.size() < sum) lists.splats.resize(sum);
  parallel_each(int(parts), [&](int part) {
    each_entry(part, [&](uint32_t& place, uint32_t number) { lists.splats[place++] = number; });
  });
}

}  // namespace wellspring::scan
