// SPDX-License-Identifier: Apache-2.0
// Where the edges of what a picture shows run between its sampling places: analytic, from the
// triangles themselves (after Persson, "Geometric Antialiasing Methods", GPU Pro 3, 2012).
#pragma once
#include <span>
#include <vector>

#include "world/raster.h"
#include "world/raster_tile.h"

namespace wellspring {

// One of two neighbouring sampling places: its triangle (null: nothing there) and inverse depth.
struct EdgeSide {
  const RasterTriangle* triangle = nullptr;
  float depth = 0;
};

// How much of each of two neighbouring pixels is covered by what the other shows; at most a half.
struct EdgeCover {
  float first = 0, second = 0;
};
// Between pixel (x, y) and the one to the right of it or, `vertical`, below. None: both show one
// smooth surface, or the edge runs rather along the other axis. `focal`: pixels a unit of slope.
EdgeCover find_edge(const EdgeSide& first, const EdgeSide& second, int x, int y, bool vertical,
                const RasterView& view, float focal);

// Half the tangent of the angle that a smooth surface may turn by (find_edge()).
inline constexpr float smooth_bend = 0.24f;

inline constexpr float least_share = 1 / 256.0f;  // that is worth mixing

// Goes through the tiles of a picture.
template <class TriangleOf>
struct EdgeFinder {
  const RasterView& view;
  float focal;
  int columns;  // of tiles
  std::span<const TilePixels> tiles;
  TriangleOf triangle_of;  // of a number in the tiles

  // Between two of a tile's own pixels.
  void find_within(int tile, std::vector<EdgeShare>& found) const {
    const TilePixels& pixels = tiles[size_t(tile)];
    ivec2 size = size_of(tile);
    for (int y = 0; y < size.y; y++)
      for (bool vertical : {false, true}) {
        if (vertical && y + 1 == size.y) break;
        const uint32_t* row = pixels.number + y * tile_width;
        int next = vertical ? tile_width : 1, pairs = size.x - !vertical;
        for (int x = 0; x < pairs; x += lane_count) {
          LaneMask here, there;
          std::memcpy(&here, row + x, sizeof here);
          std::memcpy(&there, row + x + next, sizeof there);
          unsigned differ = negative_lanes(here != there);
          bool inside = vertical ? y > 0 && y + 2 < size.y : x > 0 && x + lane_count < pairs;
          if (differ && inside) differ &= ~smooth_pairs(pixels, y * tile_width + x, next);
          if (pairs - x < lane_count) differ &= (1u << (pairs - x)) - 1;
          for (; differ != 0; differ &= differ - 1) {
            int place = y * tile_width + x + __builtin_ctz(differ);
            look(tile, place, tile, place + next, vertical, found);
          }
        }
      }
  }
  // Between a pixel of the tile to the left or above and one of this tile.
  void find_borders(int tile, std::vector<EdgeShare>& found) const {
    ivec2 size = size_of(tile);
    for (int y = 0; tile % columns > 0 && y < size.y; y++)
      look(tile - 1, y * tile_width + tile_width - 1, tile, y * tile_width, false, found);
    for (int x = 0; tile >= columns && x < size.x; x++)
      look(tile - columns, (tile_height - 1) * tile_width + x, tile, x, true, found);
  }

 private:
  // Of eight pixels from `place` on, those that lie with the next and the ones before and behind on
  // one instance's smooth surface: inverse depths of planes have no second differences, and a bend
  // shows in two of them.
  unsigned smooth_pairs(const TilePixels& pixels, int place, int next) const {
    using Kinds = uint16_t __attribute__((vector_size(2 * lane_count)));
    Kinds kind, next_kind;
    std::memcpy(&kind, pixels.kind + place, sizeof kind);
    std::memcpy(&next_kind, pixels.kind + place + next, sizeof next_kind);
    auto depth = [&](int k) { return load_lanes(pixels.depth + place + k * next); };
    Lanes a = depth(-1), b = depth(0), c = depth(1), d = depth(2);
    Lanes bend = lanes_max(lanes_abs(a - 2 * b + c), lanes_abs(b - 2 * c + d));
    LaneMask same = __builtin_convertvector(kind == next_kind, LaneMask);
    return negative_lanes(same & LaneMask(bend <= b * (smooth_bend / focal)));
  }
  ivec2 corner_of(int tile) const {
    return {tile % columns * tile_width, tile / columns * tile_height};
  }
  ivec2 size_of(int tile) const {
    return min(ivec2(tile_width, tile_height), ivec2(view.width, view.height) - corner_of(tile));
  }
  EdgeSide side_of(int tile, int place) const {
    uint32_t number = tiles[size_t(tile)].number[place];
    return {number == no_triangle ? nullptr : triangle_of(number),
            tiles[size_t(tile)].depth[place]};
  }
  void look(int tile1, int place1, int tile2, int place2, bool vertical,
            std::vector<EdgeShare>& found) const {
    EdgeSide first = side_of(tile1, place1), second = side_of(tile2, place2);
    if (first.triangle == second.triangle) return;
    ivec2 at = corner_of(tile1) + ivec2(place1 % tile_width, place1 / tile_width);
    EdgeCover edge = find_edge(first, second, at.x, at.y, vertical, view, focal);
    uint32_t a = uint32_t(at.y * view.width + at.x), b = a + uint32_t(vertical ? view.width : 1);
    if (edge.first > least_share) found.push_back({a, b, edge.first});
    if (edge.second > least_share) found.push_back({b, a, edge.second});
  }
};

}  // namespace wellspring
