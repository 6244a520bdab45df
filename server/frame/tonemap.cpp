// SPDX-License-Identifier: Apache-2.0
#include "frame/tonemap.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/parallel.h"

namespace wellspring::frame {
namespace {

// Loads eight colours, whose channels lie one after the other in memory.
Lanes3 load_colors(const float* from) {
  Lanes a = load_lanes(from), b = load_lanes(from + lane_count),
        c = load_lanes(from + 2 * lane_count);
  Lanes red = __builtin_shufflevector(a, b, 0, 3, 6, 9, 12, 15, 0, 0),
        green = __builtin_shufflevector(a, b, 1, 4, 7, 10, 13, 0, 0, 0),
        blue = __builtin_shufflevector(a, b, 2, 5, 8, 11, 14, 0, 0, 0);
  return {__builtin_shufflevector(red, c, 0, 1, 2, 3, 4, 5, 10, 13),
          __builtin_shufflevector(green, c, 0, 1, 2, 3, 4, 8, 11, 14),
          __builtin_shufflevector(blue, c, 0, 1, 2, 3, 4, 9, 12, 15)};
}

void tonemap_row(const vec3* color, int count, float exposure, uint8_t* rgb) {
  auto tonemap_eight = [&](const float* from, uint8_t* to) {
    store_pixels(to, eval_tone_curve(load_colors(from) * all_lanes(exposure)));
  };
  int i = 0;
  for (; i + lane_count <= count; i += lane_count) tonemap_eight(&color[i].x, rgb + 3 * i);
  if (i == count) return;
  float rest[3 * lane_count] = {};
  uint8_t codes[3 * lane_count];
  std::memcpy(rest, &color[i].x, size_t(count - i) * sizeof(vec3));
  tonemap_eight(rest, codes);
  std::memcpy(rgb + 3 * i, codes, 3 * size_t(count - i));
}

}  // namespace

void tonemap(const Frame& frame, const Tonemap& settings, Image8& out) {
  size_t pixels = size_t(frame.width) * size_t(frame.height);
  if (frame.color.size() != pixels)
    throw std::invalid_argument("tonemap: frame has no colour plane");
  out.width = frame.width;
  out.height = frame.height;
  out.rgb.resize(pixels * 3);
  parallel_ranges(frame.height, 16, [&](int begin, int end) {
    size_t first = size_t(begin) * size_t(frame.width), last = size_t(end) * size_t(frame.width);
    tonemap_row(&frame.color[first], int(last - first), settings.exposure, &out.rgb[first * 3]);
  });
}

}  // namespace wellspring::frame
