// SPDX-License-Identifier: Apache-2.0
#include "cache/reconstruct.h"

#include <algorithm>
#include <atomic>
#include <limits>

#include "base/parallel.h"
#include "cache/packing.h"

namespace wellspring::cache {
namespace {

vec3 color_of(const PointColor& point) {
  return unpack_albedo(point.albedo) * unpack_rgb9e5(point.smooth) + unpack_rgb9e5(point.rest);
}

}  // namespace

ShownPoints reconstruct_points(const PointCache& points, const PointImage& image, Frame& frame) {
  const int width = image.width, height = image.height;
  fit_frame(width, height, frame);
  std::atomic<int64_t> shown{0}, converged{0};
  parallel_ranges(height, 8, [&](int begin, int end) {
    ShownPoints here;
    for (int y = begin; y < end; y++)
      for (int x = 0; x < width; x++) {
        const size_t at = size_t(y) * size_t(width) + size_t(x);
        vec3 sum(0);
        float weights = 0, most = 0;
        for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); v++)
          for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); u++) {
            const size_t from = size_t(v) * size_t(width) + size_t(u);
            const uint32_t point = image.point[from];
            if (point == no_point) continue;
            const float weight = (u == x ? 2.0f : 1.0f) * (v == y ? 2.0f : 1.0f);
            sum += weight * color_of(points.color[point]);
            weights += weight;
            if (weight <= most) continue;
            most = weight;
            const bool far = image.depth[from] >= 0.5f * infinite_depth;
            frame.depth[at] = far ? std::numeric_limits<float>::infinity() : image.depth[from];
            frame.object[at] = points.color[point].object;
          }
        if (weights > 0) frame.color[at] = sum / weights;
        const uint32_t own = image.point[at];
        const uint8_t count = own == no_point ? uint8_t(0) : points.count[own];
        frame.confidence[at] = float(count) / (float(count) + 8);
        here.points += own != no_point;
        here.converged += own != no_point && count >= converged_samples;
      }
    shown += here.points;
    converged += here.converged;
  });
  return {shown, converged};
}

}  // namespace wellspring::cache
