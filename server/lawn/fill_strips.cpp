// SPDX-License-Identifier: Apache-2.0
#include "lawn/fill_strips.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wellspring::lawn {
namespace {

constexpr Lanes lane_numbers{0, 1, 2, 3, 4, 5, 6, 7};
constexpr float full = 0.996f;    // coverage behind which nothing is seen
constexpr float far_away = 1e6f;  // pixels; keeps whole numbers in their range

// Puts a fragment before or behind what the pixel holds.
inline void put(BinPixels& pixels, size_t at, float depth, float share, const Lanes& value) {
  float& covered = pixels.covered[at];
  if (depth < pixels.depth[at]) {
    pixels.value[at] = pixels.value[at] * (1 - share) + value * share;
    if (share >= 0.5f || covered < 0.5f) pixels.depth[at] = depth;
    covered += share * (1 - covered);
  } else if (covered < full) {
    const float rest = share * (1 - covered);
    pixels.value[at] += value * rest;
    if (covered < 0.5f) pixels.depth[at] = depth;
    covered += rest;
  }
}

}  // namespace

void BinPixels::clear(std::span<const float> before, int picture_width) {
  depth.fill(std::numeric_limits<float>::infinity());
  covered.fill(0);
  value.fill(Lanes{});
  limit.fill(std::numeric_limits<float>::infinity());
  if (before.empty()) return;
  for (int row = 0; row < height; row++) {
    const float* const from = &before[size_t(y + row) * size_t(picture_width) + size_t(x)];
    std::copy(from, from + width, &limit[size_t(row * bin_width)]);
  }
}

void fill_part(BinPixels& pixels, const StripPart& part, const Lanes& value, const Lanes& along,
               const Lanes& aside) {
  // `major` is the axis whose pixels are taken eight at a time: y for strips that rather stand.
  const vec2 way = abs(part.place[1] - part.place[0]);
  const int major = way.y >= way.x ? 1 : 0, minor = 1 - major;
  const vec2 corner(pixels.x, pixels.y);
  const int size[2] = {pixels.width, pixels.height};
  const int stride[2] = {1, bin_width};
  // Corners around the piece, along and across the major axis, relative to the bin.
  float p[4], q[4];
  for (int i = 0; i < 4; i++) {
    const int end = i / 2;
    const float sign = i == 0 || i == 3 ? -1.0f : 1.0f;
    const vec2 c = part.place[end] + sign * part.half[end] - corner;
    p[i] = std::clamp(c[major], -far_away, far_away);
    q[i] = std::clamp(c[minor], -far_away, far_away);
  }
  const float low = std::min({p[0], p[1], p[2], p[3]}), high = std::max({p[0], p[1], p[2], p[3]});
  const float at_row = pixels.offset[major], at_pixel = pixels.offset[minor];
  const int first = std::max(int(std::ceil(low - at_row)), 0),
            last = std::min(int(std::ceil(high - at_row)) - 1, size[major] - 1);
  if (first > last) return;
  const float most_q = std::max({q[0], q[1], q[2], q[3]}),
              least_q = std::min({q[0], q[1], q[2], q[3]});
  if (most_q < 0 || least_q > float(size[minor])) return;

  const float begin = part.place[0][major] - corner[major],
              length = part.place[1][major] - part.place[0][major];
  const float per_length = std::abs(length) > 1e-3f ? 1 / length : 0;
  const float begin_share = per_length == 0 ? 0.5f : 0;
  // The edge to which `half` points is the one of larger numbers, or the other.
  const float sign = part.half[0][minor] + part.half[1][minor] < 0 ? -1.0f : 1.0f;
  float slope[4];
  for (int i = 0; i < 4; i++) {
    const int next = (i + 1) & 3;
    slope[i] = p[next] != p[i] ? (q[next] - q[i]) / (p[next] - p[i]) : 0;
  }
  for (int row = first; row <= last; row += lane_count) {
    const Lanes at = lane_numbers + (float(row) + at_row);
    constexpr float none = std::numeric_limits<float>::max();
    Lanes from = all_lanes(none), to = -from;
    for (int i = 0; i < 4; i++) {
      const int next = (i + 1) & 3;
      const LaneMask crosses = (at >= std::min(p[i], p[next])) & (at < std::max(p[i], p[next]));
      const Lanes place = q[i] + (at - p[i]) * slope[i];
      from = crosses ? lanes_min(from, place) : from;
      to = crosses ? lanes_max(to, place) : to;
    }
    LaneMask open = (to > from) & (lane_numbers < float(last - row + 1));
    if (!any_lane(open)) continue;
    const Lanes share =
        lanes_max(lanes_min((at - begin) * per_length + begin_share, all_lanes(1)), Lanes{});
    const Lanes depth = 1.0f / (part.inverse[0] + share * (part.inverse[1] - part.inverse[0]));
    open &= depth >= pixels.near;
    const Lanes per_width = (2 * sign) / lanes_max(to - from, all_lanes(1e-6f));
    // Pixels of every row, from `x` to before `end`.
    const Lanes size_q = all_lanes(float(size[minor]));
    const Lanes shift = all_lanes(pixels.coverage ? 0.0f : at_pixel);
    const auto ceiling = [](const Lanes& v) {
      const Lanes whole = __builtin_convertvector(round_lanes(v), Lanes);
      return whole < v ? whole + 1.0f : whole;
    };
    const auto floored = [](const Lanes& v) {
      const Lanes whole = __builtin_convertvector(round_lanes(v), Lanes);
      return whole > v ? whole - 1.0f : whole;
    };
    const Lanes low_q = lanes_max(from, all_lanes(-1)), high_q = lanes_min(to, size_q + 1);
    Lanes x = lanes_max(pixels.coverage ? floored(low_q) : ceiling(low_q - shift), Lanes{});
    const Lanes end = lanes_min(ceiling(high_q - shift), size_q);
    for (open &= x < end; any_lane(open); x += 1.0f, open &= x < end) {
      const Lanes cover = pixels.coverage
                              ? positive_lanes(lanes_min(to, x + 1.0f) - lanes_max(from, x))
                              : all_lanes(1);
      const Lanes middle =
          pixels.coverage ? 0.5f * (lanes_min(to, x + 1.0f) + lanes_max(from, x)) : x + shift;
      const Lanes side = ((middle - from) * per_width - sign);
      for (unsigned left = negative_lanes(open); left != 0; left &= left - 1) {
        const int lane = __builtin_ctz(left);
        const size_t pixel = size_t((row + lane) * stride[major] + int(x[lane]) * stride[minor]);
        const float d = depth[lane];
        if (d > pixels.limit[pixel]) continue;
        if (d >= pixels.depth[pixel] && pixels.covered[pixel] >= full) continue;
        put(pixels, pixel, d, cover[lane], value + along * share[lane] + aside * side[lane]);
      }
    }
  }
}

}  // namespace wellspring::lawn
