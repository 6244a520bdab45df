// SPDX-License-Identifier: Apache-2.0
#include "attention/saliency.h"

#include <algorithm>
#include <cmath>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/simd.h"

namespace wellspring::attention {
namespace {

// Returns the least number of rows for a thread: fewer are done before another thread wakes up.
int row_grain(int width) { return 1 + (1 << 14) / (width + 1); }

// Even sides have six taps, odd ones five. Symmetric pairs are added first: the mirrored taps give
// the same bits.
struct EvenTaps {
  static float eval(float a, float b, float c, float d, float e, float f) {
    return 10 / 32.0f * (c + d) + 5 / 32.0f * (b + e) + 1 / 32.0f * (a + f);
  }
};
struct OddTaps {
  static float eval(float a, float b, float c, float d, float e, float) {
    return 6 / 16.0f * c + 4 / 16.0f * (b + d) + 1 / 16.0f * (a + e);
  }
};

template <class Taps>
void filter_row(const float* __restrict fine, int count, float* __restrict coarse) {
  for (int i = 0; i < count; i++) {
    const float* at = fine + 2 * i;
    coarse[i] = Taps::eval(at[0], at[1], at[2], at[3], at[4], at[5]);
  }
}

template <class Taps>
void filter_rows(const Plane& narrow, int y, float* __restrict coarse) {
  const float* tap[6];
  for (int i = 0; i < 6; i++) tap[i] = narrow.row(std::clamp(2 * y - 2 + i, 0, narrow.height - 1));
  for (int x = 0; x < narrow.width; x++)
    coarse[x] = Taps::eval(tap[0][x], tap[1][x], tap[2][x], tap[3][x], tap[4][x], tap[5][x]);
}

void reduce_row(const float* fine, int width, float* coarse) {
  float piece[fine_piece_size];
  for (int begin = 0; begin < half_size(width); begin += piece_size) {
    int count = std::min(piece_size, half_size(width) - begin), left = 2 * begin - 2;
    int from = std::max(left, 0), to = std::min(left + 2 * count + 4, width);
    std::fill(piece, piece + (from - left), fine[0]);
    std::copy(fine + from, fine + to, piece + (from - left));
    std::fill(piece + (to - left), piece + 2 * count + 4, fine[width - 1]);
    reduce_piece(piece, width, count, coarse + begin);
  }
}

// Holds two coarser pixels and the second one's share, for a pixel of a finer side.
struct Between {
  int a, b;
  float share;
};
Between find_between(int x, int size) {
  int last = half_size(size) - 1;
  if (size % 2 != 0) return {x / 2, std::min((x + 1) / 2, last), 0.5f};
  return x % 2 == 0 ? Between{std::max(x / 2 - 1, 0), x / 2, 0.75f}
                    : Between{x / 2, std::min(x / 2 + 1, last), 0.25f};
}

void expand_row(const float* __restrict coarse, int width, float* __restrict fine) {
  auto edge = [&](int x) {
    Between at = find_between(x, width);
    fine[x] = (1 - at.share) * coarse[at.a] + at.share * coarse[at.b];
  };
  if (width % 2 == 0) {
    edge(0);
    for (int i = 0; i < width / 2 - 1; i++) {
      fine[2 * i + 1] = 0.75f * coarse[i] + 0.25f * coarse[i + 1];
      fine[2 * i + 2] = 0.25f * coarse[i] + 0.75f * coarse[i + 1];
    }
    edge(width - 1);
    return;
  }
  for (int i = 0; i < width / 2; i++) {
    fine[2 * i] = coarse[i];
    fine[2 * i + 1] = 0.5f * (coarse[i] + coarse[i + 1]);
  }
  edge(width - 1);
}

}  // namespace

void reduce_piece(const float* fine, int size, int count, float* coarse) {
  if (size % 2 == 0) filter_row<EvenTaps>(fine, count, coarse);
  else filter_row<OddTaps>(fine, count, coarse);
}

void reduce_rows(const Plane& narrow, Plane& coarse) {
  fit_plane(narrow.width, half_size(narrow.height), coarse);
  parallel_ranges(coarse.height, row_grain(coarse.width), [&](int begin, int end) {
    for (int y = begin; y < end; y++)
      if (narrow.height % 2 == 0) filter_rows<EvenTaps>(narrow, y, coarse.row(y));
      else filter_rows<OddTaps>(narrow, y, coarse.row(y));
  });
}

void reduce(const Plane& fine, Plane& narrow, Plane& coarse) {
  fit_plane(half_size(fine.width), fine.height, narrow);
  parallel_ranges(fine.height, row_grain(fine.width), [&](int begin, int end) {
    for (int y = begin; y < end; y++) reduce_row(fine.row(y), fine.width, narrow.row(y));
  });
  reduce_rows(narrow, coarse);
}

void expand(const Plane& coarse, int width, int height, Plane& narrow, Plane& fine) {
  fit_plane(width, coarse.height, narrow);
  for (int y = 0; y < coarse.height; y++) expand_row(coarse.row(y), width, narrow.row(y));
  fit_plane(width, height, fine);
  for (int y = 0; y < height; y++) {
    Between at = find_between(y, height);
    const float *above = narrow.row(at.a), *below = narrow.row(at.b);
    float* to = fine.row(y);
    for (int x = 0; x < width; x++) to[x] = (1 - at.share) * above[x] + at.share * below[x];
  }
}

namespace {

// --- Channels --------------------------------------------------------------------------------

// Hue is seen if intensity exceeds this share of the picture's largest (Itti et al., section 2).
constexpr float dark_share = 0.1f;

struct Codes {
  Lanes r, g, b;
};
// Loads eight pixels of three bytes; 28 bytes are read.
Codes load_codes(const uint8_t* rgb) {
  using Bytes = uint8_t __attribute__((vector_size(16)));
  auto four = [](const uint8_t* from) {
    Bytes all = load_lanes<Bytes>(from);
    return lanes_as<HalfLaneBits>(
        __builtin_shufflevector(all, all, 0, 1, 2, 3, 3, 4, 5, 6, 6, 7, 8, 9, 9, 10, 11, 12));
  };
  LaneBits pixel = join_halves(four(rgb), four(rgb + 12));
  return {to_float(pixel & 255u), to_float(pixel >> 8 & 255u), to_float(pixel >> 16 & 255u)};
}

// Fills the channels of `count` pixels; `limit` is the end of the bytes that may be read.
void fill_channels(const uint8_t* rgb, const uint8_t* limit, int count, float dark,
                   float* const (&to)[channel_count]) {
  auto least = [](Lanes a, Lanes b) { return lanes_min(a, b); };
  auto positive = [](Lanes a) { return positive_lanes(a); };
  auto choose = [](LaneMask mask, Lanes a) { return keep_lanes(mask, a); };
  for (int x = 0; x < count; x += lane_count) {
    uint8_t some[28] = {};
    const uint8_t* from = rgb + 3 * x;
    if (limit - from < ptrdiff_t(sizeof some)) {
      std::memcpy(some, from, size_t(std::min(3 * (count - x), 3 * lane_count)));
      from = some;
    }
    Codes codes = load_codes(from);
    Lanes out[channel_count];
    eval_channels(codes.r, codes.g, codes.b, all_lanes(dark), least, positive, choose, out);
    for (int c = 0; c < channel_count; c++) {
      if (count - x >= lane_count) store_lanes(to[c] + x, out[c]);
      else std::memcpy(to[c] + x, &out[c], size_t(count - x) * sizeof(float));
    }
  }
}

// Returns the largest r + g + b.
int find_brightest(const Image8& picture) {
  std::atomic<int> brightest = 0;
  parallel_ranges(picture.height, 1 + (1 << 16) / (picture.width + 1), [&](int begin, int end) {
    const uint8_t* rgb = picture.rgb.data();
    size_t row = 3 * size_t(picture.width);
    int most = 0;
    for (size_t i = size_t(begin) * row; i < size_t(end) * row; i += 3)
      most = std::max(most, rgb[i] + rgb[i + 1] + rgb[i + 2]);
    int known = brightest.load();
    while (known < most && !brightest.compare_exchange_weak(known, most)) {}
  });
  return brightest;
}

// Computes scale 1 of all channels. Scale 0 exists only a piece of a row at a time.
void begin_pyramids(const Image8& picture, SaliencyWork& work) {
  float dark = dark_share * float(find_brightest(picture));
  int width = picture.width;
  for (Plane& narrow : work.narrow) fit_plane(half_size(width), picture.height, narrow);
  const uint8_t* limit = picture.rgb.data() + picture.rgb.size();
  auto narrow_row = [&](int y) {
    float piece[channel_count][fine_piece_size];
    const uint8_t* row = picture.rgb.data() + 3 * size_t(y) * size_t(width);
    for (int begin = 0; begin < half_size(width); begin += piece_size) {
      int count = std::min(piece_size, half_size(width) - begin), left = 2 * begin - 2;
      int from = std::max(left, 0), to = std::min(left + 2 * count + 4, width);
      fill_channels(row + 3 * from, limit, to - from, dark,
                    {piece[0] + (from - left), piece[1] + (from - left), piece[2] + (from - left)});
      for (int c = 0; c < channel_count; c++) {
        std::fill(piece[c], piece[c] + (from - left), piece[c][from - left]);
        std::fill(piece[c] + (to - left), piece[c] + 2 * count + 4, piece[c][to - left - 1]);
        reduce_piece(piece[c], width, count, work.narrow[size_t(c)].row(y) + begin);
      }
    }
  };
  parallel_ranges(picture.height, 1 + (1 << 13) / (width + 1), [&](int begin, int end) {
    for (int y = begin; y < end; y++) narrow_row(y);
  });
  for (size_t c = 0; c < channel_count; c++) reduce_rows(work.narrow[c], work.pyramid[c][1]);
}

// --- Maps ------------------------------------------------------------------------------------

// Differences that rounding leaves within an even picture.
constexpr float rounding = 1e-5f;

void add_plane(const Plane& from, Plane& to) {
  for (size_t i = 0; i < to.value.size(); i++) to.value[i] += from.value[i];
}

// Peaks below this share of the largest are not counted: they are the background's unevenness
// (as in the authors' own toolkit).
constexpr float least_peak = 0.1f;

// Returns whether the value at x is a local maximum among its eight neighbours. If neighbours are
// equal, the first in reading order is one.
bool is_peak(const float* above, const float* row, const float* below, int x, int width) {
  float value = row[x];
  bool left = x > 0, right = x + 1 < width;
  if (left && row[x - 1] >= value) return false;
  if (right && row[x + 1] > value) return false;
  if (above &&
      (above[x] >= value || (left && above[x - 1] >= value) || (right && above[x + 1] >= value)))
    return false;
  return !below ||
         !(below[x] > value || (left && below[x - 1] > value) || (right && below[x + 1] > value));
}

// Returns the mean of a map's local maxima except the largest, 0 if there is none.
float mean_of_lesser_peaks(const Plane& map, float largest) {
  double sum = 0;
  int count = 0;
  for (int y = 0; y < map.height; y++) {
    const float *row = map.row(y), *above = y > 0 ? map.row(y - 1) : nullptr,
                *below = y + 1 < map.height ? map.row(y + 1) : nullptr;
    for (int x = 0; x < map.width; x++)
      if (row[x] > least_peak * largest && is_peak(above, row, below, x, map.width)) {
        sum += double(row[x]);
        count++;
      }
  }
  return count > 1 ? float((sum - double(largest)) / (count - 1)) : 0;
}

float largest_of(const Plane& map) {
  return map.value.empty() ? 0 : *std::max_element(map.value.begin(), map.value.end());
}

void scale_plane(float by, Plane& map) {
  for (float& value : map.value) value *= by;
}

// Multiplies the map by (M - m)^2, where M is the largest value and m the mean of the other local
// maxima.
void weigh_by_peaks(Plane& map) {
  float largest = largest_of(map), apart = largest - mean_of_lesser_peaks(map, largest);
  scale_plane(apart * apart, map);
}

// Subtracts the surround from the centre. For colours this is the double-opponent cell: R-G in the
// centre against G-R in the surround answers (R-G)(c) + (G-R)(s), which is 0 if the colour does not
// change. Leaves the map, promoted, at scale 4 in feature.sum.
void eval_feature(const std::array<Plane, scale_count>& pyramid, int centre, int surround,
                  SaliencyWork::Feature& feature) {
  const Plane* far = &pyramid[size_t(surround)];
  for (int scale = surround - 1; scale >= centre; scale--) {
    const Plane& like = pyramid[size_t(scale)];
    Plane& finer = far == &feature.one ? feature.other : feature.one;
    expand(*far, like.width, like.height, feature.narrow, finer);
    far = &finer;
  }
  const Plane& near = pyramid[size_t(centre)];
  Plane& map = centre == saliency_scale ? feature.sum : feature.map;
  fit_plane(near.width, near.height, map);
  fit_plane(near.width, near.height, feature.less);
  for (size_t i = 0; i < map.value.size(); i++) {
    float difference = near.value[i] - far->value[i];
    map.value[i] = std::max(difference - rounding, 0.0f);
    feature.less.value[i] = std::max(-difference - rounding, 0.0f);
  }
  float range = std::max({largest_of(map), largest_of(feature.less), least_range});
  for (Plane* polarity : {&map, &feature.less}) {
    scale_plane(1 / range, *polarity);
    weigh_by_peaks(*polarity);
  }
  add_plane(feature.less, map);
  const Plane* from = &map;
  for (int scale = centre + 1; scale <= saliency_scale; scale++) {
    Plane& coarser = scale == saliency_scale ? feature.sum : feature.one;
    reduce(*from, feature.narrow, coarser);
    from = &coarser;
  }
}

}  // namespace

void promote_peaks(Plane& map) {
  if (map.value.empty()) return;
  float least = *std::min_element(map.value.begin(), map.value.end());
  float factor = 1 / std::max(largest_of(map) - least, least_range);
  for (float& value : map.value) value = (value - least) * factor;
  weigh_by_peaks(map);
}

void eval_saliency(const Image8& picture, SaliencyWork& work, SaliencyMap& saliency) {
  saliency.offset = vec2(0);
  if (picture.width <= 0 || picture.height <= 0) return fit_plane(0, 0, saliency.map);
  begin_pyramids(picture, work);
  parallel_for(channel_count, [&](int c) {
    auto& pyramid = work.pyramid[size_t(c)];
    for (size_t scale = 2; scale < scale_count; scale++)
      reduce(pyramid[scale - 1], work.narrow[size_t(c)], pyramid[scale]);
  });
  parallel_for(feature_count, [&](int i) {
    int centre = 2 + i / 2 % 3, surround = centre + 3 + i % 2;
    eval_feature(work.pyramid[size_t(i / maps_a_channel)], centre, surround,
                 work.feature[size_t(i)]);
  });
  const Plane& like = work.pyramid[0][saliency_scale];
  for (Plane& conspicuity : work.conspicuity) {
    fit_plane(like.width, like.height, conspicuity);
    std::fill(conspicuity.value.begin(), conspicuity.value.end(), 0.0f);
  }
  for (size_t i = 0; i < feature_count; i++)
    add_plane(work.feature[i].sum, work.conspicuity[i < maps_a_channel ? 0 : 1]);
  for (Plane& conspicuity : work.conspicuity) promote_peaks(conspicuity);
  fit_plane(like.width, like.height, saliency.map);
  for (size_t i = 0; i < saliency.map.value.size(); i++)
    saliency.map.value[i] = 0.5f * (work.conspicuity[0].value[i] + work.conspicuity[1].value[i]);
  scale_plane(1 / std::max(largest_of(saliency.map), least_range), saliency.map);
  int width = picture.width, height = picture.height;
  for (int scale = 0; scale < saliency_scale; scale++) {
    saliency.offset =
        vec2(coarser_place(saliency.offset.x, width), coarser_place(saliency.offset.y, height));
    width = half_size(width);
    height = half_size(height);
  }
}

size_t memory_bytes(const SaliencyWork& work) {
  size_t bytes = 0;
  for (const auto& pyramid : work.pyramid)
    for (const Plane& plane : pyramid) bytes += bytes_of(plane.value);
  for (const Plane& plane : work.narrow) bytes += bytes_of(plane.value);
  for (const auto& f : work.feature)
    bytes += bytes_of(f.narrow.value, f.one.value, f.other.value, f.less.value, f.map.value,
                      f.sum.value);
  for (const Plane& plane : work.conspicuity) bytes += bytes_of(plane.value);
  return bytes;
}

}  // namespace wellspring::attention
