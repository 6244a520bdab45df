// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "base/parallel.h"
#include "cache/project.h"

namespace wellspring {

void depth_cull(PointCache& points, float threshold, PointImage& image) {
  int width = image.width, height = image.height;
  if (width < 3 || height < 3) return;
  float factor = 1 + std::max(threshold, 0.0f);
  // The verdict is kept apart until all rows have been judged; priority is free until attend().
  uint8_t* verdict = image.priority.data();
  parallel_ranges(height, 8, [&](int begin, int end) {
    for (int y = begin; y < end; y++) {
      uint8_t* out = verdict + size_t(y) * size_t(width);
      std::fill(out, out + width, uint8_t(0));
      if (y == 0 || y == height - 1) continue;
      const float* row = image.depth.data() + size_t(y) * size_t(width);
      const float* above = row - width;
      const float* below = row + width;
      for (int x = 1; x < width - 1; x++) {
        float depth = row[x];
        auto nearer = [=](float z) { return int32_t(z > 0.0f) & int32_t(z * factor < depth); };
        int32_t a = nearer(above[x - 1]), b = nearer(above[x]), c = nearer(above[x + 1]);
        int32_t d = nearer(row[x - 1]), e = nearer(row[x + 1]);
        int32_t f = nearer(below[x - 1]), g = nearer(below[x]), h = nearer(below[x + 1]);
        int32_t count = a + b + c + d + e + f + g + h;
        int32_t sx = c + e + h - a - d - f, sy = f + g + h - a - b - c;
        // The mean offset of the nearer neighbours is short when they lie around the pixel.
        out[x] = uint8_t(int32_t(count >= 2) & int32_t(2 * (sx * sx + sy * sy) <= count * count));
      }
    }
  });
  parallel_ranges(height, 8, [&](int begin, int end) {
    for (size_t i = size_t(begin) * size_t(width); i < size_t(end) * size_t(width); i++) {
      if (!verdict[i] || image.point[i] == no_point) continue;
      uint8_t& flags = points.flags[image.point[i]];
      if (flags & point_verified) continue;
      flags &= uint8_t(~point_visible);
      image.point[i] = no_point;
      image.depth[i] = 0;
    }
  });
}

}  // namespace wellspring
