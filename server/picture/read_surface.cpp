// SPDX-License-Identifier: Apache-2.0
#include "picture/read_surface.h"

#include <algorithm>
#include <atomic>

#include "base/parallel.h"

namespace wellspring::picture {

ShownPoints read_surface(const WindowView& view, const PointCache& points, const PointImage& image,
                         Cells& cells, Frame& frame) {
  std::atomic<int64_t> shown{0}, converged{0};
  parallel_ranges(cells.height, 4, [&](int begin, int end) {
    thread_local SurfaceRows rows;
    rows.start(image.width, 2 * cell_size);
    ShownPoints here;
    int next = begin * cell_size - 1, last = end * cell_size;
    for (int cy = begin; cy < end; cy++) {
      int top = cy * cell_size, bottom = top + cell_size;
      for (; next <= bottom; next++) {
        int enough = read_points(points, image, next, rows);
        if (next >= begin * cell_size && next < last) here.converged += enough;
      }
      build_cells(view, rows, cy, cells);
      for (int y = top; y < std::min(bottom, image.height); y++)
        here.points += fill_from_neighbours(rows, y, frame);
    }
    shown += here.points;
    converged += here.converged;
  });
  return {shown, converged};
}

}  // namespace wellspring::picture
