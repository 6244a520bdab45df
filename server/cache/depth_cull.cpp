// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include "base/parallel.h"
#include "cache/project.h"

namespace wellspring {

namespace {

constexpr int reach = 2;  // rows and columns looked at on every side

constexpr int run = 64;  // pixels judged together

// Marks the pixels of one row whose point lies behind what surrounds it. `rows` are five rows of
// depths, the judged one in the middle, each padded by `reach` (and `run` at the end) empty pixels.
void judge_row(const float* const* rows, int width, float factor, uint8_t* verdict) {
  alignas(64) int32_t valid[run], nearer[run], sx[run], sy[run];
  for (int x0 = 0; x0 < width; x0 += run) {
    const float* middle = rows[reach] + x0;
    for (int i = 0; i < run; i++) valid[i] = nearer[i] = sx[i] = sy[i] = 0;
    for (int dy = -reach; dy <= reach; dy++)
      for (int dx = -reach; dx <= reach; dx++) {
        const float* other = rows[dy + reach] + x0 + dx;
        for (int i = 0; i < run; i++) {
          int32_t there = -int32_t(other[i] > 0.0f),
                  before = there & -int32_t(other[i] * factor < middle[i]);
          valid[i] -= there;
          nearer[i] -= before;
          sx[i] += dx & before;
          sy[i] += dy & before;
        }
      }
    int count = std::min(run, width - x0);
    for (int i = 0; i < run; i++) {
      // Nearer neighbours on all sides have a short mean offset; those of a silhouette a long one.
      int32_t around =
          int32_t(nearer[i] >= 4) & int32_t(sx[i] * sx[i] + sy[i] * sy[i] <= nearer[i] * nearer[i]);
      int32_t alone = int32_t(nearer[i] >= 3) & int32_t(4 * nearer[i] >= 3 * (valid[i] - 1));
      valid[i] = around | alone;
    }
    for (int i = 0; i < count; i++) verdict[x0 + i] = uint8_t(valid[i]);
  }
}

}  // namespace

void depth_cull(PointCache& points, float threshold, PointImage& image) {
  int width = image.width, height = image.height;
  float factor = 1 + std::max(threshold, 0.0f);
  // The verdict is kept apart until all rows have been judged; priority is free until attend().
  uint8_t* verdicts = image.priority.data();
  parallel_ranges(height, 16, [&](int begin, int end) {
    thread_local std::vector<float> padded;
    size_t stride = size_t(width) + 2 * reach + run;
    padded.assign(stride * (2 * reach + 1), 0.0f);
    auto load = [&](int y) {
      float* row = padded.data() + size_t(y + reach) % (2 * reach + 1) * stride + reach;
      if (y < 0 || y >= height)
        std::fill_n(row, width, 0.0f);
      else
        std::copy_n(image.depth.data() + size_t(y) * size_t(width), width, row);
    };
    for (int y = begin - reach; y < begin + reach; y++) load(y);
    for (int y = begin; y < end; y++) {
      load(y + reach);
      const float* rows[2 * reach + 1];
      for (int dy = -reach; dy <= reach; dy++)
        rows[dy + reach] =
            padded.data() + size_t(y + dy + reach) % (2 * reach + 1) * stride + reach;
      judge_row(rows, width, factor, verdicts + size_t(y) * size_t(width));
    }
  });
  parallel_ranges(height, 16, [&](int begin, int end) {
    for (size_t i = size_t(begin) * size_t(width); i < size_t(end) * size_t(width); i++) {
      if (!verdicts[i] || image.point[i] == no_point) continue;
      uint8_t& flags = points.flags[image.point[i]];
      if (flags & point_verified) continue;
      flags &= uint8_t(~point_visible);
      image.point[i] = no_point;
      image.depth[i] = 0;
    }
  });
}

}  // namespace wellspring
