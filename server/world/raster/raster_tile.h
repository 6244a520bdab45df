// SPDX-License-Identifier: Apache-2.0
// Holds the z-buffer of one tile of a picture, and draws triangles into it.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>

#include "base/simd.h"
#include "world/raster/raster_setup.h"

namespace wellspring::world {

// Describes how a picture's edges cut its pixels: Raster finds this, and code that softens edges
// uses it.

// Holds the share of `pixel` (counted row after row from the picture's top left) that is covered by
// the surface that `other`, a neighbour or a pixel near, shows: above 0, at most a half. Exact if
// one straight edge cuts the pixel.
struct EdgeShare {
  uint32_t pixel = 0, other = 0;
  float share = 0;
};

// Returns by how many codes of 255 `count` pixels side by side (at most eight; other lanes:
// anything) differ from those `step` further on. Edges that change less than a code or two are left
// out; if the function is empty, none is.
using PixelsDiffer = std::function<Lanes(uint32_t pixel, uint32_t step, int count)>;

// So that depths and numbers fit into the first-level cache.
inline constexpr int tile_width = 64, tile_height = 32;
inline constexpr uint32_t no_triangle = 0xffffffffu;

struct TilePixels {
  alignas(32) float depth[tile_width * tile_height];  // inverse; 0: nothing there
  // Padded, as lanes are read beyond its end.
  alignas(32) uint32_t number[tile_width * tile_height + lane_count];
  // Tells instances apart, and, if thin_kind is set, triangles; set by hand_out().
  uint16_t kind[tile_width * tile_height + lane_count];
  static constexpr uint16_t thin_kind = 0x8000;
  // The least depth of squares of `square` pixels, for triangles that lie behind all of a square;
  // bits of squares that have changed since it was found.
  static constexpr int square = 16, across = tile_width / square;
  float least[tile_width * tile_height / (square * square)];
  uint32_t stale = 0;

  // Clears the tile, of which `columns` and `rows` lie in the picture.
  void start(int columns, int rows) {
    std::fill(std::begin(number), std::end(number), no_triangle);
    for (int y = 0; y < tile_height; y++) {
      float* row = depth + y * tile_width;
      // Pixels outside the picture are full.
      std::fill(row, row + tile_width, y < rows ? 0.0f : INFINITY);
      if (y < rows) std::fill(row + columns, row + tile_width, INFINITY);
    }
    stale = (1u << std::size(least)) - 1;
  }
  void find_all_least() {
    for (int y = 0; y < tile_height / square; y++)
      for (int x = 0; x < across; x++)
        if (stale >> (y * across + x) & 1) find_least(x, y);
  }
  // Returns whether some of the squares with pixels between these corners, inclusive, have a pixel
  // behind `depth`.
  bool any_behind(int x0, int y0, int x1, int y1, float depth) {
    for (int y = y0 / square; y <= y1 / square; y++)
      for (int x = x0 / square; x <= x1 / square; x++) {
        int i = y * across + x;
        if (stale >> i & 1) find_least(x, y);
        if (least[i] < depth) return true;
      }
    return false;
  }
  void find_least(int x, int y) {
    Lanes low = all_lanes(INFINITY);
    for (int row = y * square; row < (y + 1) * square; row++)
      for (int i = 0; i < square; i += lane_count)
        low = lanes_min(low, load_lanes(depth + row * tile_width + x * square + i));
    float lowest = low[0];
    for (int i = 1; i < lane_count; i++) lowest = std::min(lowest, low[i]);
    least[y * across + x] = lowest;
    stale &= ~(1u << (y * across + x));
  }
};

// Evaluates a linear function over the picture at pixel (x, y) of it.
inline float eval_at(vec3 f, const RasterTriangle& t, const RasterView& view, int x, int y) {
  return f.x + f.y * (float(x) - view.centre_x - t.corner.x) +
         f.z * (float(y) - view.centre_y - t.corner.y);
}

inline vec2 barycentric_at(const RasterTriangle& t, const RasterView& view, int x, int y,
                           float depth) {
  float u = std::clamp(eval_at(t.u, t, view, x, y) / depth, 0.0f, 1.0f);
  float v = std::clamp(eval_at(t.v, t, view, x, y) / depth, 0.0f, 1.0f);
  float most = std::max(u + v, 1.0f);
  return {u / most, v / most};
}

// Holds a triangle's edges and depth at the pixels of a tile.
struct TileEdges {
  // Pixels of the tile, inclusive, that its bounds meet; x0 a multiple of eight.
  int x0, y0, x1, y1;
  int32_t a[3], b[3];  // whole pixels' steps
  int32_t edge[3];     // at (x0, y0); far from the edge only its sign is right
  float depth;         // inverse depth at (x0, y0)
};
// Finds the edges. False: the triangle covers no pixel of the tile.
inline bool find_edges(const RasterTriangle& t, const RasterView& view, int tile_x, int tile_y,
                       TileEdges& e) {
  e.x0 = std::max(int(t.left) - tile_x, 0) & ~(lane_count - 1);
  e.x1 = std::min(int(t.right) - tile_x, tile_width - 1);
  e.y0 = std::max(int(t.top) - tile_y, 0);
  e.y1 = std::min(int(t.bottom) - tile_y, tile_height - 1);
  for (int i = 0; i < 3; i++) {
    // Steps are whole pixels, so the remainder never matters again.
    int64_t steps_x = int64_t(tile_x + e.x0) * raster_steps - view.centre_steps_x - t.from_x[i];
    int64_t steps_y = int64_t(tile_y + e.y0) * raster_steps - view.centre_steps_y - t.from_y[i];
    int64_t exact = (t.a[i] * steps_x + t.b[i] * steps_y + t.bias[i]) >> raster_step_bits;
    int64_t highest = exact + std::max(int64_t(t.a[i]) * (e.x1 - e.x0), int64_t(0)) +
                      std::max(int64_t(t.b[i]) * (e.y1 - e.y0), int64_t(0));
    if (highest < 0) return false;
    e.edge[i] = int32_t(std::clamp<int64_t>(exact, -(1 << 29), 1 << 29));
    e.a[i] = t.a[i], e.b[i] = t.b[i];
  }
  e.depth = eval_at(t.depth, t, view, tile_x + e.x0, tile_y + e.y0);
  return true;
}

// Holds eight rows' pixels, counted from x0: those from `first` to `last` may be covered, none if
// last < first; those from `first_inside` to `last_inside` are, whatever rounding does.
struct TileSpans {
  alignas(32) int32_t first[lane_count], last[lane_count], first_inside[lane_count],
      last_inside[lane_count];
};
// Finds the spans of the rows from y0 + `row` on.
inline void find_spans(const TileEdges& e, int row, TileSpans& spans) {
  constexpr LaneMask lane{0, 1, 2, 3, 4, 5, 6, 7};
  const float end = float(e.x1 - e.x0);
  Lanes low = all_lanes(-2), high = all_lanes(end + 2);
  for (int i = 0; i < 3; i++) {
    LaneMask edge = e.edge[i] + e.b[i] * (row + lane);
    if (e.a[i] == 0) {
      high = edge < 0 ? all_lanes(-4) : high;
      continue;
    }
    Lanes at = __builtin_convertvector(edge, Lanes) * (-1.0f / float(e.a[i]));
    if (e.a[i] > 0) low = lanes_max(low, at);
    else high = lanes_min(high, at);
  }
  low = lanes_min(low, all_lanes(tile_width + 4)), high = lanes_max(high, all_lanes(-4));
  auto put = [](int32_t* to, const Lanes& x) {
    store_lanes(to, __builtin_convertvector(x, LaneMask));
  };
  put(spans.first, lanes_max(low - 1, all_lanes(0)));
  put(spans.last, lanes_min(high + 1, all_lanes(end)));
  put(spans.first_inside, low + 2), put(spans.last_inside, high - 2);
}

// Calls body(place of eight pixels in the tile, their depths, bits of the pixels that the triangle
// covers in front of all drawn before).
template <class Body>
[[gnu::always_inline]] inline void cover(const RasterTriangle& t, const RasterView& view,
                                         int tile_x, int tile_y, TilePixels& pixels,
                                         const Body& body) {
  constexpr LaneMask lane{0, 1, 2, 3, 4, 5, 6, 7};
  TileEdges e;
  if (!find_edges(t, view, tile_x, tile_y, e)) return;
  // Small triangles are drawn sooner than a test whether they show.
  constexpr int small = 64;
  if ((e.x1 - e.x0 + 1) * (e.y1 - e.y0 + 1) > small &&
      !pixels.any_behind(e.x0, e.y0, e.x1, e.y1, t.most_depth))
    return;
  LaneMask across[3];
  for (int i = 0; i < 3; i++) across[i] = e.a[i] * lane;
  Lanes depth_across = t.depth.y * Lanes{0, 1, 2, 3, 4, 5, 6, 7};
  auto cover_eight = [&](int x, int y, LaneMask outside) {
    unsigned covered = ~negative_lanes(outside) & 0xff;
    if (!covered) return;
    Lanes depth = e.depth + t.depth.y * float(x) + t.depth.z * float(y) + depth_across;
    depth = lanes_max(lanes_min(depth, all_lanes(t.most_depth)), all_lanes(t.least_depth));
    int place = (e.y0 + y) * tile_width + e.x0 + x;
    covered &= negative_lanes(LaneMask(depth > load_lanes(pixels.depth + place)));
    if (covered) body(place, depth, covered);
  };
  int rows = e.y1 - e.y0 + 1;
  if (e.x1 - e.x0 < lane_count) {
    LaneMask e0 = e.edge[0] + across[0], e1 = e.edge[1] + across[1], e2 = e.edge[2] + across[2];
    for (int y = 0; y < rows; y++) {
      cover_eight(0, y, e0 | e1 | e2);
      e0 += e.b[0], e1 += e.b[1], e2 += e.b[2];
    }
    return;
  }
  // Wide triangles leave most of their bounds empty.
  TileSpans spans;
  for (int row = 0; row < rows; row += lane_count) {
    find_spans(e, row, spans);
    for (int k = 0, y = row; k < lane_count && y < rows; k++, y++)
      for (int x = spans.first[k] & ~(lane_count - 1); x <= spans.last[k]; x += lane_count) {
        LaneMask outside{};
        if (x < spans.first_inside[k] || x + lane_count - 1 > spans.last_inside[k])
          for (int i = 0; i < 3; i++) outside |= (e.edge[i] + e.b[i] * y + e.a[i] * x) + across[i];
        cover_eight(x, y, outside);
      }
  }
}

}  // namespace wellspring::world
