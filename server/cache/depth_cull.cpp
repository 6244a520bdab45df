// SPDX-License-Identifier: Apache-2.0
// Depths are compared as 16-bit codes, sixteen pixels at a time.
#include <algorithm>
#include <bit>
#include <vector>

#include "base/parallel.h"
#include "base/simd.h"
#include "cache/project.h"

namespace wellspring::cache {

namespace {

constexpr int reach = 2;  // rows and columns looked at on every side
constexpr int window = 2 * reach + 1;
constexpr int run = 16;  // pixels judged together
using ShortLanes = int16_t __attribute__((vector_size(2 * run)));

// 1024 steps an octave from 2^-14 m to 2^50 m: fine enough for a threshold of some percent.
constexpr int32_t least_depth = (127 - 14) << 23;
constexpr int16_t nothing = 32767;  // an empty pixel: nearer than none
constexpr int16_t nearest = -32768;

int16_t code_of(float depth) {
  int32_t code = (std::bit_cast<int32_t>(depth) - least_depth) >> 13;
  code = code > 0 ? code : 0;
  return int16_t((code < 65534 ? code : 65534) - 32768);
}

// The last rows of the picture as codes, each padded by `reach` and a run of empty pixels.
struct Codes {
  size_t stride = 0;
  std::vector<int16_t> rows, limit;  // limit: what is nearer than that hides the pixel
  int16_t* row(int y) { return rows.data() + size_t(y + reach) % window * stride + reach; }
  void start(int width) {
    stride = size_t(width) + 2 * reach + run;
    rows.assign(stride * window, nothing);
    limit.assign(stride, nearest);
  }
  void read(const PointImage& image, int y) {
    int16_t* codes = row(y);
    if (y < 0 || y >= image.height) {
      std::fill_n(codes, image.width, nothing);
      return;
    }
    const float* depth = image.depth.data() + size_t(y) * size_t(image.width);
    for (int x = 0; x < image.width; x++) codes[x] = depth[x] > 0.0f ? code_of(depth[x]) : nothing;
  }
  void read_limit(const PointImage& image, int y, float share) {
    const float* depth = image.depth.data() + size_t(y) * size_t(image.width);
    for (int x = 0; x < image.width; x++) limit[size_t(x)] = code_of(depth[x] * share);
  }
};

// All bits where a pixel's point lies behind what surrounds it. `rows` point at the first pixel.
ShortLanes judge(const int16_t* const* rows, const int16_t* limits) {
  ShortLanes limit = load_lanes<ShortLanes>(limits), columns[window] = {}, lines[window] = {};
#pragma GCC unroll 5
  for (int dy = 0; dy < window; dy++)
#pragma GCC unroll 5
    for (int dx = 0; dx < window; dx++) {
      ShortLanes nearer = load_lanes<ShortLanes>(rows[dy] + dx - reach) < limit;
      columns[dx] += nearer;
      lines[dy] += nearer;
    }
  ShortLanes nearer = -(columns[0] + columns[1] + columns[2] + columns[3] + columns[4]);
  ShortLanes several = nearer >= 3;
  if (!any_lane(several)) return several;
  ShortLanes sx = 2 * (columns[4] - columns[0]) + columns[3] - columns[1],
             sy = 2 * (lines[4] - lines[0]) + lines[3] - lines[1], others = ShortLanes{} - 1;
  for (int dy = 0; dy < window; dy++)
    for (int dx = 0; dx < window; dx++)
      others -= load_lanes<ShortLanes>(rows[dy] + dx - reach) != nothing;
  // Nearer neighbours on all sides have a short mean offset; those of a silhouette a long one. They
  // hide only as the majority: through a lattice the background shows rightly.
  ShortLanes around =
      (nearer >= 4) & (2 * nearer >= others) & (sx * sx + sy * sy <= nearer * nearer);
  ShortLanes alone = several & (4 * nearer >= 3 * others);
  return around | alone;
}

}  // namespace

void depth_cull(PointCache& points, float threshold, PointImage& image) {
  int width = image.width, height = image.height;
  float share = 1 / (1 + std::max(threshold, 0.0f));
  // The verdict is kept apart until all rows have been judged; priority is free until attend().
  uint8_t* verdicts = image.priority.data();
  parallel_ranges(height, 16, [&](int begin, int end) {
    thread_local Codes codes;
    codes.start(width);
    for (int y = begin - reach; y < begin + reach; y++) codes.read(image, y);
    for (int y = begin; y < end; y++) {
      codes.read(image, y + reach);
      codes.read_limit(image, y, share);
      uint8_t* verdict = verdicts + size_t(y) * size_t(width);
      for (int x = 0; x < width; x += run) {
        const int16_t* rows[window];
        for (int dy = 0; dy < window; dy++) rows[dy] = codes.row(y + dy - reach) + x;
        ShortLanes hidden = judge(rows, codes.limit.data() + x);
        for (int i = 0; i < std::min(run, width - x); i++) verdict[x + i] = uint8_t(hidden[i]);
      }
    }
  });
  parallel_ranges(height, 16, [&](int begin, int end) {
    size_t last = size_t(end) * size_t(width);
    for (size_t i = size_t(begin) * size_t(width); i < last; i++) {
      uint64_t eight;
      if (i + 8 <= last && (std::memcpy(&eight, verdicts + i, 8), eight == 0)) {
        i += 7;
        continue;
      }
      if (!verdicts[i] || image.point[i] == no_point) continue;
      uint8_t& flags = points.flags[image.point[i]];
      if (flags & point_verified) continue;
      flags &= uint8_t(~point_visible);
      image.point[i] = no_point;
      image.depth[i] = 0;
    }
  });
}

}  // namespace wellspring::cache
