// SPDX-License-Identifier: Apache-2.0
// Makes min-max mipmaps of a picture (Nichols and Wyman 2009, section 3.2): of its depth, of the
// three components of its unit normals, and, which the paper lacks, of the distance of each pixel's
// tangent plane from the eye. A plane has one such distance however steeply it is looked at, so
// that its range of depth alone is no discontinuity.
#pragma once
#include <vector>

#include "base/memory.h"
#include "base/simd.h"
#include "light/transport_plan.h"
#include "light/visible/surface_buffer.h"
#include "world/view.h"

namespace wellspring::light {

// Describes the pixels of a view that light falls on, row by row, as a visibility pass or rays
// found them. The arrays are borrowed, each of width * height numbers.

struct SplatPixels {
  View view;
  vec2 offset{0.5f};             // sampling place in its pixel
  const float* depth = nullptr;  // along the viewing axis; infinite, NaN, <= 0: nothing is lit
  const float *nx = nullptr, *ny = nullptr, *nz = nullptr;  // unit normal, towards the eye
  const vec3* position = nullptr;  // scene coordinates, if more exact than by depth; or null
};

inline bool is_lit(const SplatPixels& pixels, size_t i) {
  return pixels.depth[i] > 0 && pixels.depth[i] < std::numeric_limits<float>::infinity();
}
inline PixelGrid make_pixel_grid(const SplatPixels& pixels) {
  return PixelGrid(pixels.view, pixels.offset);
}
inline vec3 place_from_eye(const SplatPixels& pixels, const PixelGrid& grid, int x, int y) {
  size_t i = size_t(y) * size_t(pixels.view.width) + size_t(x);
  if (pixels.position) return pixels.position[i] - pixels.view.position;
  return (grid.corner + grid.right * float(x) + grid.down * float(y)) * pixels.depth[i];
}

// Holds the least depth, nx, ny, nz of a square of pixels, then the greatest, negated; and the same
// of its planes. Pixels where nothing is lit have infinite depth and nothing else: `low_high[0]` is
// infinite if there are no others, `low_high[4]` is -infinity if there is one of them.
struct MinMaxCell {
  float low_high[lane_count];
  float plane_low, plane_high;
};
// Returns the cell of both squares together.
inline MinMaxCell join_cells(const MinMaxCell& a, const MinMaxCell& b) {
  MinMaxCell both;
  store_lanes(both.low_high, lanes_min(load_lanes(a.low_high), load_lanes(b.low_high)));
  both.plane_low = a.plane_low < b.plane_low ? a.plane_low : b.plane_low;
  both.plane_high = a.plane_high > b.plane_high ? a.plane_high : b.plane_high;
  return both;
}

struct MinMaxLevel {
  int columns = 0, rows = 0;
  size_t first = 0;  // index of its first cell in `cells`
};
// Holds levels of squares: level k has squares of 2^k pixels; level 0, the picture, is not kept.
// The last column and row may stick out of the picture.
struct MinMaxPyramid {
  std::vector<MinMaxLevel> levels;
  RawVector<MinMaxCell> cells;
  const MinMaxCell& at(int level, int x, int y) const {
    const MinMaxLevel& l = levels[size_t(level)];
    return cells[l.first + size_t(y) * size_t(l.columns) + size_t(x)];
  }
};

// Returns the cell of one pixel alone.
MinMaxCell look_at_pixel(const SplatPixels& pixels, const PixelGrid& grid, int x, int y);

// Returns the coarsest level of a picture by the settings, 0: pixels alone; then the finest.
int coarsest_level(const SplatSettings& settings, int width, int height);
inline int finest_level(const SplatSettings& settings, int coarsest) {
  return settings.levels < 0 || settings.levels > coarsest ? 0 : coarsest - settings.levels;
}
// Makes level `coarsest` and those below. Runs on all cores.
void make_min_max_pyramid(const SplatPixels& pixels, int coarsest, MinMaxPyramid& pyramid);

// Returns whether depth and normals vary more than one subsplat may hide, for a cell with something
// lit.
inline bool is_discontinuous(const MinMaxCell& cell, const SplatSettings& settings) {
  const float* v = cell.low_high;
  const float most = settings.normal_threshold;
  bool alike = -v[1] - v[5] <= most && -v[2] - v[6] <= most && -v[3] - v[7] <= most;
  if (!alike) return true;
  float allowed = settings.depth_threshold * v[0];
  if (-v[4] - v[0] <= allowed) return false;
  return !(cell.plane_high - cell.plane_low <= allowed) ||
         !(-v[4] < std::numeric_limits<float>::infinity());
}

}  // namespace wellspring::light
