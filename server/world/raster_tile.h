// SPDX-License-Identifier: Apache-2.0
// The z-buffer of one tile of a picture, and how a triangle is drawn into it.
#pragma once
#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/lanes.h"
#include "world/raster_setup.h"

namespace wellspring {

inline constexpr int tile_width = 64, tile_height = 32;  // depths and numbers fit the first cache
inline constexpr uint32_t no_triangle = 0xffffffffu;

struct TilePixels {
  alignas(32) float depth[tile_width * tile_height];  // inverse; 0: nothing there
  alignas(32) uint32_t number[tile_width * tile_height];
  // The least depth of squares of `square` pixels, for triangles that lie behind all of one; bits
  // of those that have changed since it was found.
  static constexpr int square = 16, across = tile_width / square;
  float least[tile_width * tile_height / (square * square)];
  uint32_t stale = 0;

  // Empty, with `columns` and `rows` of it in the picture.
  void start(int columns, int rows) {
    std::fill(std::begin(number), std::end(number), no_triangle);
    for (int y = 0; y < tile_height; y++) {
      float* row = depth + y * tile_width;
      std::fill(row, row + tile_width, y < rows ? 0.0f : INFINITY);  // beyond nothing is missing
      if (y < rows) std::fill(row + columns, row + tile_width, INFINITY);
    }
    stale = (1u << std::size(least)) - 1;
  }
  void find_all_least() {
    for (int y = 0; y < tile_height / square; y++)
      for (int x = 0; x < across; x++)
        if (stale >> (y * across + x) & 1) find_least(x, y);
  }
  // Does a part of the pixels inclusive of these corners lie behind `depth`?
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

// A linear function over the picture at pixel (x, y) of it.
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

// Calls body(place of eight pixels in the tile, their depths, bit for each that the triangle covers
// in front of all before).
template <class Body>
void cover(const RasterTriangle& t, const RasterView& view, int tile_x, int tile_y,
           TilePixels& pixels, const Body& body) {
  int x0 = std::max(int(t.left) - tile_x, 0) & ~(lane_count - 1);
  int x1 = std::min(int(t.right) - tile_x, tile_width - 1);
  int y0 = std::max(int(t.top) - tile_y, 0), y1 = std::min(int(t.bottom) - tile_y, tile_height - 1);
  if (!pixels.any_behind(x0, y0, x1, y1, t.most_depth)) return;
  constexpr LaneMask lane{0, 1, 2, 3, 4, 5, 6, 7};
  LaneMask edge[3], along[3], down[3];
  for (int i = 0; i < 3; i++) {
    // Steps are whole pixels, so the remainder never matters again; far from the edge only its sign
    // does.
    int64_t steps_x = int64_t(tile_x + x0) * raster_steps - view.centre_steps_x - t.from_x[i];
    int64_t steps_y = int64_t(tile_y + y0) * raster_steps - view.centre_steps_y - t.from_y[i];
    int64_t exact = (t.a[i] * steps_x + t.b[i] * steps_y + t.bias[i]) >> raster_step_bits;
    edge[i] = int(std::clamp<int64_t>(exact, -(1 << 29), 1 << 29)) + t.a[i] * lane;
    along[i] = LaneMask{} + t.a[i] * lane_count;
    down[i] = LaneMask{} + t.b[i];
  }
  // Wide triangles are mostly not where their bounds are: each row begins where its edges say, a
  // pixel early for rounding.
  bool wide = x1 - x0 >= 2 * lane_count;
  float inverse[3] = {};
  for (int i = 0; wide && i < 3; i++) inverse[i] = t.a[i] != 0 ? -1.0f / float(t.a[i]) : 0;
  float start = eval_at(t.depth, t, view, tile_x + x0, tile_y + y0);
  Lanes row_depth = start + t.depth.y * Lanes{0, 1, 2, 3, 4, 5, 6, 7};
  for (int y = y0; y <= y1; y++) {
    LaneMask e0 = edge[0], e1 = edge[1], e2 = edge[2];
    Lanes depth = row_depth;
    int x = x0, end = x1;
    if (wide) {
      float low = 0, high = float(x1 - x0);
      for (int i = 0; i < 3; i++) {
        float at = float(edge[i][0]) * inverse[i];
        if (t.a[i] > 0) low = std::max(low, at);
        if (t.a[i] < 0) high = std::min(high, at);
        if (t.a[i] == 0 && edge[i][0] < 0) high = -2;
      }
      int groups = std::max(int(std::min(low, float(tile_width))) - 1, 0) / lane_count;
      end = x0 + int(std::max(high, -2.0f) + 1);
      end = std::min(end, x1);
      if (groups > 0) {
        e0 += along[0] * groups, e1 += along[1] * groups, e2 += along[2] * groups;
        depth += t.depth.y * float(groups * lane_count);
        x += groups * lane_count;
      }
    }
    for (; x <= end; x += lane_count) {
      unsigned covered = ~negative_lanes(e0 | e1 | e2) & 0xff;
      if (covered) {
        int place = y * tile_width + x;
        Lanes d = lanes_max(lanes_min(depth, all_lanes(t.most_depth)), all_lanes(t.least_depth));
        covered &= negative_lanes(LaneMask(d > load_lanes(pixels.depth + place)));
        if (covered) body(place, d, covered);
      }
      e0 += along[0], e1 += along[1], e2 += along[2];
      depth += t.depth.y * float(lane_count);
    }
    for (int i = 0; i < 3; i++) edge[i] += down[i];
    row_depth += t.depth.z;
  }
}

}  // namespace wellspring
