// SPDX-License-Identifier: Apache-2.0
// Finds where the edges of a picture's surfaces run between its sampling places: analytic, from the
// triangles themselves (after Persson, "Geometric Antialiasing Methods", GPU Pro 3, 2012).
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "world/raster/raster_setup.h"
#include "world/raster/raster_tile.h"
#include "world/view.h"
#include "world/world.h"

namespace wellspring::world {

// Finds where a surface ends that is made of triangles narrower than a pixel: bars, tubes and
// mouldings, of which sampling places meet one face and miss the next. The line from one sampling
// place towards the next is followed from triangle to triangle over their common edges.

// Holds which triangles of a mesh meet along their edges; vertices at the same place are the same.
struct MeshNeighbours {
  static constexpr uint32_t none = 0xffffffffu;
  // For each triangle over its edge from corner k to the next: triangle * 4 + its own edge there.
  // Or none: nothing, or more than one.
  std::vector<std::array<uint32_t, 3>> over;
  // The least width of a triangle and its neighbours, from edge to opposite corner, in mesh space.
  std::vector<float> width;
  // Not 0: the triangle is part of something long and thin; it has a crease, or its surface ends
  // there.
  std::vector<uint8_t> bar;
};
MeshNeighbours find_neighbours(const Mesh& mesh);

// Describes an edge on the way from one sampling place to the next: pixels up to it, and the change
// of these a pixel to the side.
struct EdgeLine {
  float at = 2, slope = 0;
};

// Describes the end of a triangle that covers the place (x, y) on the way to the neighbour at
// `step` along the axis; beyond 1: it does not end before the neighbour.
struct TriangleExit : EdgeLine {
  int edge = 0;  // number of the triangle's edge
};
TriangleExit exit_of(const RasterTriangle& t, int x, int y, int step, bool vertical,
                     const RasterView& view);

// Follows surfaces of the picture that is drawn.
struct SurfaceWalk {
  const World& world;
  const std::vector<MeshNeighbours>& meshes;
  const std::vector<uint32_t>& mesh_of;  // mesh of every instance
  const View& view;
  const RasterView& raster;
  float focal;  // pixels a unit of slope

  // Goes from the place (x, y), which the triangle covers and whose `exit` is given, to where its
  // surface ends or turns away on the way to the neighbour at `step` along the axis; beyond 1: it
  // does not.
  EdgeLine end_of(const RasterTriangle& t, const TriangleExit& exit, int x, int y, int step,
                  bool vertical) const;
};

// Holds one of two neighbouring sampling places: its triangle (null: nothing there) and inverse
// depth.
struct EdgeSide {
  const RasterTriangle* triangle = nullptr;
  float depth = 0;
};

// Pixels; narrower surfaces are followed between sampling places (SurfaceWalk).
inline constexpr float thin_width = 1.5f;

// Holds how much of each of two neighbouring pixels is covered by what the other shows; at most a
// half.
struct EdgeCover {
  float first = 0, second = 0;
};
// Finds the edge between pixel (x, y) and the one to the right of it or, `vertical`, below. None:
// both show one smooth surface, or the edge runs rather along the other axis.
EdgeCover find_edge(const EdgeSide& first, const EdgeSide& second, int x, int y, bool vertical,
                    const SurfaceWalk& walk);

// Does the same for what is seen between the two, both of them narrow, which may be of one
// instance.
EdgeCover find_gap(const EdgeSide& first, const EdgeSide& second, int x, int y, bool vertical,
                   const SurfaceWalk& walk);

// Half the tangent of the angle that a smooth surface may turn by (find_edge()).
inline constexpr float smooth_bend = 0.24f;

// Bounds for mixing: codes between neighbours, changed codes, and a share.
inline constexpr float alike = 9, least_change = 0.75f, least_share = 1 / 256.0f;
inline constexpr float behind_both = 0.97f;  // ratio of inverse depths

// Finds the edges in all tiles of a picture.
template <class TriangleOf>
struct EdgeFinder {
  const SurfaceWalk& walk;
  const RasterView& view;
  int columns;  // number of tile columns
  const PixelsDiffer& differ;
  std::span<const TilePixels> tiles;
  TriangleOf triangle_of;  // returns the triangle of a number in the tiles

  // Finds edges between two of a tile's own pixels.
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
          unsigned asked = negative_lanes(here != there);
          const int first = y * tile_width + x, count = std::min(pairs - x, lane_count);
          bool inside = vertical ? y > 0 && y + 2 < size.y : x > 0 && x + lane_count < pairs;
          if (asked && inside) asked &= ~smooth_pairs(pixels, first, next);
          asked &= (1u << count) - 1;
          if (!asked) continue;
          const Lanes codes = codes_between(pixel_at(tile, first), vertical, count);
          asked &= negative_lanes(LaneMask(codes > alike)) | thin_pairs(pixels, first, next);
          for (; asked != 0; asked &= asked - 1) {
            const int k = __builtin_ctz(asked);
            look(tile, first + k, tile, first + k + next, vertical, codes[k], found);
          }
        }
      }
  }
  // Finds edges between a pixel of the tile to the left or above and one of this tile.
  void find_borders(int tile, std::vector<EdgeShare>& found) const {
    ivec2 size = size_of(tile);
    for (int y = 0; tile % columns > 0 && y < size.y; y++)
      look(tile - 1, y * tile_width + tile_width - 1, tile, y * tile_width, false, found);
    for (int x = 0; tile >= columns && x < size.x; x++)
      look(tile - columns, (tile_height - 1) * tile_width + x, tile, x, true, found);
  }

 private:
  using Kinds = uint16_t __attribute__((vector_size(2 * lane_count)));

  uint32_t pixel_at(int tile, int place) const {
    const ivec2 at = corner_of(tile) + ivec2(place % tile_width, place / tile_width);
    return uint32_t(at.y * view.width + at.x);
  }
  Lanes codes_between(uint32_t pixel, bool vertical, int count) const {
    return differ ? differ(pixel, vertical ? uint32_t(view.width) : 1, count) : all_lanes(INFINITY);
  }
  // Returns which of eight pixels from `place` on are thin, together with the next ones.
  unsigned thin_pairs(const TilePixels& pixels, int place, int next) const {
    const Kinds both =
        load_lanes<Kinds>(pixels.kind + place) & load_lanes<Kinds>(pixels.kind + place + next);
    return negative_lanes(__builtin_convertvector(both, LaneMask) << 16);
  }
  // Returns which of eight pixels from `place` on lie with the next and the ones before and behind
  // on one instance's smooth surface: inverse depths of planes have no second differences, and a
  // bend shows in two of them.
  unsigned smooth_pairs(const TilePixels& pixels, int place, int next) const {
    const Kinds kind = load_lanes<Kinds>(pixels.kind + place),
                next_kind = load_lanes<Kinds>(pixels.kind + place + next);
    auto depth = [&](int k) { return load_lanes(pixels.depth + place + k * next); };
    Lanes a = depth(-1), b = depth(0), c = depth(1), d = depth(2);
    Lanes bend = lanes_max(lanes_abs(a - 2 * b + c), lanes_abs(b - 2 * c + d));
    LaneMask same = __builtin_convertvector(kind == next_kind, LaneMask);
    return negative_lanes(same & LaneMask(bend <= b * (smooth_bend / walk.focal)));
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
    if (tiles[size_t(tile1)].number[place1] == tiles[size_t(tile2)].number[place2]) return;
    const Lanes codes = codes_between(pixel_at(tile1, place1), vertical, 1);
    look(tile1, place1, tile2, place2, vertical, codes[0], found);
  }
  // Looks at two pixels that show different triangles, and differ by so many codes.
  void look(int tile1, int place1, int tile2, int place2, bool vertical, float codes,
            std::vector<EdgeShare>& found) const {
    const TilePixels &one = tiles[size_t(tile1)], &other = tiles[size_t(tile2)];
    const uint32_t a = pixel_at(tile1, place1), b = a + uint32_t(vertical ? view.width : 1);
    const ivec2 at(int(a) % view.width, int(a) / view.width);
    bool thin = (one.kind[place1] & other.kind[place2] & TilePixels::thin_kind) != 0;
    bool differs = codes > alike;
    if (!thin && !differs) return;
    ivec2 behind(-1);
    if (thin) behind = find_behind(tile1, place1, std::min(one.depth[place1], other.depth[place2]));
    if (behind.x < 0 && !differs) return;
    EdgeSide first = side_of(tile1, place1), second = side_of(tile2, place2);
    auto add = [&](const EdgeCover& edge, uint32_t seen_by_a, uint32_t seen_by_b, float least) {
      if (edge.first > least) found.push_back({a, seen_by_a, edge.first});
      if (edge.second > least) found.push_back({b, seen_by_b, edge.second});
    };
    EdgeCover gap;
    if (behind.x >= 0) gap = find_gap(first, second, at.x, at.y, vertical, walk);
    uint32_t seen = uint32_t(behind.y * view.width + behind.x);
    if (gap.first + gap.second > least_share) add(gap, seen, seen, least_share);
    else if (differs)
      add(find_edge(first, second, at.x, at.y, vertical, walk), b, a,
          std::max(least_change / codes, least_share));
  }
  // Returns the nearest pixel of the tile that shows what is behind; (-1, -1): there is none near.
  ivec2 find_behind(int tile, int place, float depth) const {
    constexpr int farthest = 4;
    ivec2 last = size_of(tile) - 1, from(place % tile_width, place / tile_width);
    const float* depths = tiles[size_t(tile)].depth;
    for (int far = 1; far <= farthest; far++) {
      int left = std::max(from.x - far, 0), right = std::min(from.x + far, last.x);
      int top = std::max(from.y - far, 0), bottom = std::min(from.y + far, last.y);
      for (ivec2 at :
           {ivec2(right, from.y), ivec2(left, from.y), ivec2(from.x, bottom), ivec2(from.x, top)})
        if (depths[at.y * tile_width + at.x] < behind_both * depth) return corner_of(tile) + at;
    }
    return ivec2(-1);
  }
};

}  // namespace wellspring::world
