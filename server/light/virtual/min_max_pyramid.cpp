// SPDX-License-Identifier: Apache-2.0
#include "light/virtual/min_max_pyramid.h"

#include <algorithm>
#include <bit>

#include "base/parallel.h"

namespace wellspring::light {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

MinMaxCell nothing() {
  MinMaxCell cell;
  std::fill_n(cell.low_high, lane_count, infinity);
  cell.plane_low = infinity, cell.plane_high = -infinity;
  return cell;
}

}  // namespace

MinMaxCell look_at_pixel(const SplatPixels& pixels, const PixelGrid& grid, int x, int y) {
  const size_t i = size_t(y) * size_t(pixels.view.width) + size_t(x);
  if (!is_lit(pixels, i)) {
    MinMaxCell cell = nothing();
    cell.low_high[4] = -infinity;
    return cell;
  }
  const vec3 n(pixels.nx[i], pixels.ny[i], pixels.nz[i]);
  const float z = pixels.depth[i];
  const float plane = dot(n, place_from_eye(pixels, grid, x, y));
  return {{z, n.x, n.y, n.z, -z, -n.x, -n.y, -n.z}, plane, plane};
}

int coarsest_level(const SplatSettings& settings, int width, int height) {
  const int side = std::min(width, height), least = std::max(settings.coarsest, 1);
  return side <= least ? 0 : std::bit_width(unsigned(side / least)) - 1;
}

void make_min_max_pyramid(const SplatPixels& pixels, int coarsest, MinMaxPyramid& pyramid) {
  const int width = pixels.view.width, height = pixels.view.height;
  pyramid.levels.assign(size_t(coarsest) + 1, {});
  size_t total = 0;
  for (int k = 0; k <= coarsest; k++) {
    const int size = 1 << k;
    MinMaxLevel& level = pyramid.levels[size_t(k)];
    level = {(width + size - 1) / size, (height + size - 1) / size, total};
    if (k > 0) total += size_t(level.columns) * size_t(level.rows);
  }
  if (pyramid.cells.size() < total) pyramid.cells.resize(total);
  const PixelGrid grid = make_pixel_grid(pixels);
  for (int k = 1; k <= coarsest; k++) {
    const MinMaxLevel &to = pyramid.levels[size_t(k)], &from = pyramid.levels[size_t(k) - 1];
    parallel_ranges(to.rows, 4, [&](int begin, int end) {
      for (int y = begin; y < end; y++)
        for (int x = 0; x < to.columns; x++) {
          MinMaxCell cell = nothing();
          for (int j = 2 * y; j < std::min(2 * y + 2, from.rows); j++)
            for (int i = 2 * x; i < std::min(2 * x + 2, from.columns); i++)
              cell = join_cells(
                  cell, k == 1 ? look_at_pixel(pixels, grid, i, j) : pyramid.at(k - 1, i, j));
          pyramid.cells[to.first + size_t(y) * size_t(to.columns) + size_t(x)] = cell;
        }
    });
  }
}

}  // namespace wellspring::light
