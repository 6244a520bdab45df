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
  if (covered == 0) {
    pixels.value[at] = value * share;
    pixels.depth[at] = depth;
    covered = share;
  } else if (depth < pixels.depth[at]) {
    pixels.value[at] = pixels.value[at] * (1 - share) + value * share;
    if (share >= 0.5f || covered < 0.5f) pixels.depth[at] = depth;
    covered += share * (1 - covered);
  } else {
    const float rest = share * (1 - covered);
    pixels.value[at] += value * rest;
    if (covered < 0.5f) pixels.depth[at] = depth;
    covered += rest;
  }
}

Lanes round_up(const Lanes& v) {
  const Lanes whole = __builtin_convertvector(round_lanes(v), Lanes);
  return whole < v ? whole + 1.0f : whole;
}
Lanes round_down(const Lanes& v) {
  const Lanes whole = __builtin_convertvector(round_lanes(v), Lanes);
  return whole > v ? whole - 1.0f : whole;
}

// Says along which axis lines of pixels are taken eight at a time: along y for what rather stands,
// whose lines are rows, else along x.
struct Lines {
  int major, minor;
  int count, size;           // lines of the bin, and pixels of each
  int stride, pixel_stride;  // from line to line, and along a line
  float at_line, at_pixel;   // sampling place

  Lines(const BinPixels& pixels, int major_axis) : major(major_axis), minor(1 - major_axis) {
    const int sizes[2] = {pixels.width, pixels.height}, strides[2] = {1, bin_width};
    count = sizes[major], size = sizes[minor];
    stride = strides[major], pixel_stride = strides[minor];
    at_line = pixels.offset[major], at_pixel = pixels.offset[minor];
  }
};

// Fills the `open` ones of eight lines from `line` on, each between two places on it, relative to
// the bin. `value_of(lane, side)` returns values of a place between the middle and edges, -1 to 1.
template <class ValueOf>
[[gnu::always_inline]] inline void fill_lines(BinPixels& pixels, const Lines& lines, int line,
                                              LaneMask open, const Lanes& from, const Lanes& to,
                                              const Lanes& depth, const ValueOf& value_of) {
  constexpr LaneMask whole_lanes{0, 1, 2, 3, 4, 5, 6, 7};
  open &= (to > from) & (depth >= pixels.near);
  const Lanes size = all_lanes(float(lines.size));
  const Lanes shift = all_lanes(pixels.coverage ? 0.0f : lines.at_pixel);
  const Lanes low = lanes_max(from, all_lanes(-1)), high = lanes_min(to, size + 1);
  Lanes x = positive_lanes(pixels.coverage ? round_down(low) : round_up(low - shift));
  const Lanes end = lanes_min(round_up(high - shift), size);
  open &= x < end;
  if (!any_lane(open)) return;
  const Lanes per_width = 2.0f / lanes_max(to - from, all_lanes(1e-6f));
  LaneMask place = (line + whole_lanes) * lines.stride +
                   __builtin_convertvector(x, LaneMask) * lines.pixel_stride;
  do {
    Lanes cover = all_lanes(1), middle = x + shift;
    if (pixels.coverage) {
      const Lanes begin = lanes_max(from, x), stop = lanes_min(to, x + 1.0f);
      cover = positive_lanes(stop - begin), middle = 0.5f * (begin + stop);
    }
    const Lanes side = (middle - from) * per_width - 1.0f;
    for (unsigned left = negative_lanes(open); left != 0; left &= left - 1) {
      const int lane = __builtin_ctz(left);
      const size_t pixel = size_t(place[lane]);
      const float d = depth[lane];
      if (d >= pixels.depth[pixel] && pixels.covered[pixel] >= full) continue;
      if (pixels.is_limited && d > pixels.limit[pixel]) continue;
      put(pixels, pixel, d, cover[lane], value_of(lane, side[lane]));
    }
    x += 1.0f, place += lines.pixel_stride;
    open &= x < end;
  } while (any_lane(open));
}

// Fills the quadrilateral from joint k to the next.
void fill_segment(BinPixels& pixels, const Strip& strip, int k) {
  const vec2 corner(pixels.x, pixels.y);
  const vec2 place[2] = {vec2(strip.x[k], strip.y[k]) - corner,
                         vec2(strip.x[k + 1], strip.y[k + 1]) - corner};
  const vec2 half[2] = {{strip.half_x[k], strip.half_y[k]},
                        {strip.half_x[k + 1], strip.half_y[k + 1]}};
  const vec2 way = abs(place[1] - place[0]);
  const Lines lines(pixels, way.y >= way.x ? 1 : 0);
  float p[4], q[4];  // corners around it, along and across the major axis
  for (int i = 0; i < 4; i++) {
    const int end = i / 2;
    const vec2 c = place[end] + (i == 0 || i == 3 ? -1.0f : 1.0f) * half[end];
    p[i] = std::clamp(c[lines.major], -far_away, far_away);
    q[i] = std::clamp(c[lines.minor], -far_away, far_away);
  }
  const float low = std::min({p[0], p[1], p[2], p[3]}), high = std::max({p[0], p[1], p[2], p[3]});
  const int first = std::max(int(std::ceil(low - lines.at_line)), 0),
            last = std::min(int(std::ceil(high - lines.at_line)), lines.count) - 1;
  if (first > last || std::max({q[0], q[1], q[2], q[3]}) < 0 ||
      std::min({q[0], q[1], q[2], q[3]}) > float(lines.size))
    return;
  const float begin = place[0][lines.major], length = place[1][lines.major] - begin;
  const float per_length = std::abs(length) > 1e-3f ? 1 / length : 0;
  const float begin_share = per_length == 0 ? 0.5f : 0;
  const float sign = half[0][lines.minor] + half[1][lines.minor] < 0 ? -1.0f : 1.0f;
  float slope[4];
  for (int i = 0; i < 4; i++) {
    const int next = (i + 1) & 3;
    slope[i] = p[next] != p[i] ? (q[next] - q[i]) / (p[next] - p[i]) : 0;
  }
  const Lanes value = strip.value[k], along = strip.value[k + 1] - value;
  for (int line = first; line <= last; line += lane_count) {
    const Lanes at = lane_numbers + (float(line) + lines.at_line);
    constexpr float none = std::numeric_limits<float>::max();
    Lanes from = all_lanes(none), to = -from;
    for (int i = 0; i < 4; i++) {
      const int next = (i + 1) & 3;
      const LaneMask crosses = (at >= std::min(p[i], p[next])) & (at < std::max(p[i], p[next]));
      const Lanes place_on = q[i] + (at - p[i]) * slope[i];
      from = crosses ? lanes_min(from, place_on) : from;
      to = crosses ? lanes_max(to, place_on) : to;
    }
    const Lanes share =
        positive_lanes(lanes_min((at - begin) * per_length + begin_share, all_lanes(1)));
    const Lanes depth =
        1.0f / (strip.inverse[k] + share * (strip.inverse[k + 1] - strip.inverse[k]));
    fill_lines(pixels, lines, line, lane_numbers < float(last - line + 1), from, to, depth,
               [&](int lane, float side) {
                 return value + along * share[lane] + strip.aside * (sign * side);
               });
  }
}

// Fills a thin strip at once, if it goes one way along an axis: its middle and half of its width
// are piecewise linear along that. False: it is not such a strip.
bool fill_thin(BinPixels& pixels, const Strip& strip) {
  constexpr float thin = 1.5f;  // pixels of half a width
  const float *along = strip.y, *across = strip.x, *half_along = strip.half_y,
              *half_across = strip.half_x;
  const Lines lines(
      pixels,
      std::abs(strip.y[segments] - strip.y[0]) >= std::abs(strip.x[segments] - strip.x[0]) ? 1 : 0);
  if (lines.major == 0) std::swap(along, across), std::swap(half_along, half_across);
  const float sign = along[segments] < along[0] ? -1.0f : 1.0f;
  const vec2 corner(pixels.x, pixels.y);
  float p[joints], q[joints], half[joints], length[segments], per_length[segments];
  for (int k = 0; k < joints; k++) {
    p[k] = sign * (along[k] - corner[lines.major]), q[k] = across[k] - corner[lines.minor];
    if (!(std::abs(p[k]) < far_away && std::abs(q[k]) < far_away)) return false;
  }
  for (int k = 0; k < segments; k++) {
    length[k] = p[k + 1] - p[k];
    if (!(length[k] > 0.01f && std::abs(q[k + 1] - q[k]) < 2 * length[k])) return false;
    per_length[k] = 1 / length[k];
  }
  for (int k = 0; k < joints; k++) {
    const int before = std::max(k - 1, 0), after = std::min(k + 1, segments);
    const float slope = (q[after] - q[before]) / (p[after] - p[before]);
    half[k] = half_across[k] - slope * sign * half_along[k];
    if (std::abs(half[k]) > thin) return false;
  }
  const float edge = half[0] + half[1] < 0 ? -1.0f : 1.0f;
  const float low = sign > 0 ? p[0] : -p[segments], high = sign > 0 ? p[segments] : -p[0];
  const int first = std::max(int(std::ceil(low - lines.at_line)), 0),
            last = std::min(int(std::ceil(high - lines.at_line)), lines.count) - 1;
  float slope_q[segments], slope_half[segments], slope_inverse[segments];
  for (int k = 0; k < segments; k++) {
    slope_q[k] = (q[k + 1] - q[k]) * per_length[k];
    slope_half[k] = (std::abs(half[k + 1]) - std::abs(half[k])) * per_length[k];
    slope_inverse[k] = (strip.inverse[k + 1] - strip.inverse[k]) * per_length[k];
  }
  for (int line = first; line <= last; line += lane_count) {
    const Lanes at = sign * (lane_numbers + (float(line) + lines.at_line));
    Lanes middle = all_lanes(q[0]), wide = all_lanes(std::abs(half[0])),
          inverse = all_lanes(strip.inverse[0]), share{};
    for (int k = 0; k < segments; k++) {
      const Lanes part = positive_lanes(lanes_min(at - p[k], all_lanes(length[k])));
      middle += part * slope_q[k], wide += part * slope_half[k];
      inverse += part * slope_inverse[k], share += part * per_length[k];
    }
    const LaneMask segment =
        __builtin_convertvector(lanes_min(share, all_lanes(segments - 0.001f)), LaneMask);
    const Lanes rest = share - __builtin_convertvector(segment, Lanes);
    fill_lines(pixels, lines, line, lane_numbers < float(last - line + 1), middle - wide,
               middle + wide, 1.0f / inverse, [&](int lane, float side) {
                 const Lanes* const value = &strip.value[segment[lane]];
                 return value[0] + (value[1] - value[0]) * rest[lane] + strip.aside * (edge * side);
               });
  }
  return true;
}

}  // namespace

void BinPixels::clear(std::span<const float> before, int picture_width) {
  depth.fill(std::numeric_limits<float>::infinity());
  covered.fill(0);
  is_limited = !before.empty();
  for (int row = 0; is_limited && row < height; row++) {
    const float* const from = &before[size_t(y + row) * size_t(picture_width) + size_t(x)];
    std::copy(from, from + width, &limit[size_t(row * bin_width)]);
  }
}

void fill_strip(BinPixels& pixels, const Strip& strip) {
  if (fill_thin(pixels, strip)) return;
  for (int k = 0; k < segments; k++) fill_segment(pixels, strip, k);
}

}  // namespace wellspring::lawn
