// SPDX-License-Identifier: Apache-2.0
// Which pixels are worth a look: see looks.h.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "base/rng.h"
#include "cache/lanes.h"
#include "cache/looks.h"

namespace wellspring {
namespace {

constexpr float crease = 0.7f;      // cosine below which two normals are two surfaces
constexpr int enough_samples = 16;  // spread over a pixel at rest: their mean needs no looks
constexpr int32_t least_gain = 12;  // of 255: below that nobody would see the difference
constexpr int32_t edge_gain = 8;    // of an edge, however equal both sides seem

// One row of the picture, the same again beyond its ends: the display luminance, 0 to 255, that
// pixels are likely to have (their reflectance in the light of the nearest cell, and their own
// rest), their objects and normals.
struct Row {
  static constexpr int before = 2 * lanes, after = 2 * lanes;
  std::vector<int32_t> luma;
  std::vector<uint32_t> object, more;
  std::vector<float> light;
  void start(int width) {
    size_t size = size_t(width) + before + after;
    luma.resize(size), object.resize(size), more.resize(size), light.resize(size);
  }
};

// About the tone map's curve: only differences matter.
f8 display_level(const f8& light) {
  f8 shown = light / (light + 1.0f), root;
  for (int i = 0; i < lanes; i++) root[i] = std::sqrt(shown[i]);
  return 255.0f * root;
}

// The packed words of one plane, of eight pixels from where a four begins.
u8 packed_lanes(const Frame& frame, SurfacePlane plane, int x, int y) {
  if (x >= 0 && x + lanes <= frame.width) {
    const uint32_t* words = packed_words(frame, x, y);
    return join(load<u4>(words + packed_four * plane),
                load<u4>(words + packed_four * (plane + 3)));
  }
  uint32_t words[lanes] = {};
  for (int half = 0; half < lanes; half += packed_four) {
    PackedFour four(x + half, frame.width);
    if (four.count > 0)
      std::memcpy(words + four.first - x, packed_words(frame, four.first, y) + four.count * plane,
                  size_t(four.count) * sizeof(uint32_t));
  }
  return load<u8>(words);
}

void read_row(const Cells& cells, const Frame& frame, int y, Row& row) {
  int width = frame.width;
  y = std::clamp(y, 0, frame.height - 1);
  for (int cx = 0; cx < cells.width; cx++) {
    size_t i = size_t(cells.index(cx, y / cell_size));
    float light = luminance(vec3(cells.smooth[0][i], cells.smooth[1][i], cells.smooth[2][i]));
    for (int k = 0; k < cell_size; k++)
      row.light[size_t(Row::before + cx * cell_size + k)] = light;
  }
  for (int x = packed_start; x < width; x += lanes) {
    f8 r, g, b;
    unpack_albedo(packed_lanes(frame, plane_albedo, x, y), r, g, b);
    f8 light = luminance(r, g, b) * load<f8>(&row.light[size_t(Row::before + x)]);
    unpack_rgb9e5(packed_lanes(frame, plane_rest, x, y), r, g, b);
    f8 level = display_level(light + luminance(r, g, b));
    store(&row.luma[size_t(Row::before + x)], __builtin_convertvector(level, i8));
  }
  size_t start = size_t(y) * size_t(width);
  std::copy_n(&frame.object[start], width, &row.object[Row::before]);
  std::memcpy(&row.more[Row::before], &frame.confidence[start], size_t(width) * sizeof(uint32_t));
  auto extend = [width](auto& values) {
    values[Row::before - 1] = values[Row::before];
    std::fill_n(&values[size_t(Row::before + width)], Row::after,
                values[size_t(Row::before + width - 1)]);
  };
  extend(row.luma), extend(row.object), extend(row.more);
}

// What eight pixels gain for being beside those that begin at `other`.
i8 gain_beside(const Row& row, size_t at, const Row& beside, size_t other) {
  i8 difference = load<i8>(&row.luma[at]) - load<i8>(&beside.luma[other]);
  difference = difference < 0 ? -difference : difference;
  f8 ax, ay, az, bx, by, bz;
  unpack_octahedron(load<u8>(&row.more[at]) & 0xffffu, ax, ay, az);
  unpack_octahedron(load<u8>(&beside.more[other]) & 0xffffu, bx, by, bz);
  f8 facing = ax * bx + ay * by + az * bz,
     lengths2 = (ax * ax + ay * ay + az * az) * (bx * bx + by * by + bz * bz);
  u8 a = load<u8>(&row.object[at]), b = load<u8>(&beside.object[other]);
  i8 bent = (facing <= 0.0f) | (facing * facing < crease * crease * lengths2);
  i8 edge = (a != b) | (bent & (a != 0u));
  return difference + (edge & (difference + edge_gain));
}

}  // namespace

void find_edges(const View& view, const Cells& cells, const StillImage& still, const Frame& frame,
                PointImage& image) {
  int width = view.width, height = view.height;
  parallel_ranges(height, 8, [&](int begin, int end) {
    thread_local std::array<Row, 3> rows;
    for (Row& row : rows) row.start(width);
    auto row_of = [&](int y) -> Row& { return rows[size_t(y + 3) % 3]; };
    for (int y = begin - 1; y <= begin; y++) read_row(cells, frame, y, row_of(y));
    for (int y = begin; y < end; y++) {
      read_row(cells, frame, y + 1, row_of(y + 1));
      const Row &above = row_of(y - 1), &row = row_of(y), &below = row_of(y + 1);
      size_t start = size_t(y) * size_t(width);
      for (int x = 0; x < width; x += lanes) {
        size_t at = size_t(Row::before + x);
        i8 gain = gain_beside(row, at, row, at - 1), other = gain_beside(row, at, row, at + 1);
        gain = gain > other ? gain : other;
        other = gain_beside(row, at, above, at);
        gain = gain > other ? gain : other;
        other = gain_beside(row, at, below, at);
        gain = gain > other ? gain : other;
        for (int i = 0; i < std::min(lanes, width - x); i++) {
          size_t pixel = start + size_t(x + i);
          bool known = (still.count[pixel] & ~still_fresh) >= enough_samples;
          image.priority[pixel] =
              known || gain[i] < least_gain ? 0 : uint8_t(std::min(gain[i], 255));
        }
      }
    }
  });
}

void choose_looks(const PointImage& image, size_t most, uint64_t seed,
                  std::vector<uint32_t>& pixels) {
  pixels.clear();
  const std::vector<uint8_t>& gain = image.priority;
  if (most >= gain.size()) {
    pixels.resize(gain.size());
    std::iota(pixels.begin(), pixels.end(), 0u);
    return;
  }
  std::array<size_t, 256> count{};
  for (uint8_t g : gain) count[g]++;
  // All that gain more than `least`, and of those that gain just as much the share that is left.
  int least = 255;
  size_t above = 0;
  while (least > 0 && above + count[size_t(least)] <= most) above += count[size_t(least--)];
  uint64_t chance = 0;
  if (least > 0) chance = ((most - above) << 32) / count[size_t(least)];
  pixels.reserve(most);
  for (size_t i = 0; i < gain.size(); i++) {
    if (gain[i] < least || gain[i] == 0 || pixels.size() == most) continue;
    if (gain[i] == least && (mix64(seed ^ i) >> 32) >= chance) continue;
    pixels.push_back(uint32_t(i));
  }
}

}  // namespace wellspring
