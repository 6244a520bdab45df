// SPDX-License-Identifier: Apache-2.0
#include "picture/warp_picture.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/memory.h"
#include "base/worker.h"
#include "picture/warp_source.h"

namespace wellspring::picture {
namespace {

using namespace warping;
constexpr int block = Keyframe::block;
static_assert(block == lane_count);
constexpr int most_steps = 96;  // steps along an epipolar line
// Blocks written per block, on average, when bounds are carried forward.
constexpr int most_blocks = 24;
// Width of a keyframe over that of the border at which it passes into the next.
constexpr int seam_across = 64;
constexpr float found = 0.5f;   // pixels that disparities of one surface may be apart in a line
constexpr float meets = 1;      // pixels between a place and itself, carried there and back
constexpr float same = 0.125f;  // pixels between places of a block that one disparity stands for

// Bounds the disparities of every block of the new view by the keyframe's blocks carried forward.
// Returns false if they would spread over too many blocks.
bool carry_bounds(const Source& source, const View& view, WarpBounds& bounds) {
  const Keyframe& k = source.k;
  const Mapping& m = source.back;
  int columns = (view.width + block - 1) / block, rows = (view.height + block - 1) / block;
  bounds.farthest.assign(size_t(columns) * size_t(rows), std::numeric_limits<float>::infinity());
  bounds.nearest.assign(bounds.farthest.size(), -1);
  int64_t left = int64_t(most_blocks) * columns * rows;
  constexpr Lanes corner_x{0, 1, 0, 1, 0, 1, 0, 1}, corner_y{0, 0, 1, 1, 0, 0, 1, 1};
  for (int by = 0; by < k.rows; by++)
    for (int bx = 0; bx < k.columns; bx++) {
      size_t b = size_t(by) * size_t(k.columns) + size_t(bx);
      float near = k.nearest[b], far = k.farthest[b];
      Lanes s{far, far, far, far, near, near, near, near};
      Lanes qx = (corner_x + float(bx)) * float(block), qy = (corner_y + float(by)) * float(block);
      Lanes z = m.one.z + qx * m.across.z + qy * m.down.z + s * m.baseline.z;
      LaneMask seen = z > least_depth;
      Lanes inverse = 1.0f / lanes_max(z, all_lanes(least_depth));
      Lanes x = (m.one.x + qx * m.across.x + qy * m.down.x + s * m.baseline.x) * inverse *
                (1.0f / block),
            y = (m.one.y + qx * m.across.y + qy * m.down.y + s * m.baseline.y) * inverse *
                (1.0f / block),
            w = s * inverse;
      float left_x = least(seen ? x : all_lanes(float(columns))),
            right_x = most(seen ? x : all_lanes(-1)),
            top = least(seen ? y : all_lanes(float(rows))), bottom = most(seen ? y : all_lanes(-1));
      if (!(right_x >= 0 && bottom >= 0 && left_x < float(columns) && top < float(rows))) continue;
      int x0 = std::max(int(left_x), 0),
          x1 = std::min(int(std::min(right_x, float(columns))), columns - 1);
      int y0 = std::max(int(top), 0), y1 = std::min(int(std::min(bottom, float(rows))), rows - 1);
      left -= int64_t(x1 - x0 + 1) * (y1 - y0 + 1);
      if (left < 0) return false;
      float low = least(seen ? w : all_lanes(std::numeric_limits<float>::infinity())),
            high = most(seen ? w : all_lanes(-1));
      for (int cy = y0; cy <= y1; cy++)
        for (int cx = x0; cx <= x1; cx++) {
          size_t c = size_t(cy) * size_t(columns) + size_t(cx);
          bounds.farthest[c] = std::min(bounds.farthest[c], low);
          bounds.nearest[c] = std::max(bounds.nearest[c], high);
        }
    }
  return true;
}

// Bounds a block that nothing was carried to by those around; at infinity if there are none.
void borrow_bounds(const WarpBounds& bounds, int columns, int rows, int bx, int by, float& far,
                   float& near) {
  far = std::numeric_limits<float>::infinity(), near = -1;
  for (int reach : {1, 4}) {
    for (int y = std::max(by - reach, 0); y <= std::min(by + reach, rows - 1); y++)
      for (int x = std::max(bx - reach, 0); x <= std::min(bx + reach, columns - 1); x++) {
        size_t c = size_t(y) * size_t(columns) + size_t(x);
        far = std::min(far, bounds.farthest[c]), near = std::max(near, bounds.nearest[c]);
      }
    if (near >= 0) return;
  }
  far = near = 0;
}

// Says where eight neighbours' epipolar lines run, in steps of a pixel or less from the nearest to
// the farthest disparity.
struct Search {
  float nearest = 0, step = 0;
  int steps = 0;
  bool look = true;  // if there are no steps: the surface may lie beside the middle disparity
  float pixels = 0;  // pixels a unit of disparity, at most
};
Search plan_search(const Source& source, float x, float y, float near, float far) {
  const Mapping& m = source.to;
  vec3 base = m.one + x * m.across + y * m.down;
  auto at = [&](float w) {
    vec3 h = base + w * m.baseline;
    float z = std::max(h.z, least_depth);
    return vec3(h.x / z, h.y / z, z);
  };
  vec3 a = at(near), b = at(far);
  auto speed = [&](vec3 p) { return length(vec2(m.baseline) - vec2(p) * m.baseline.z) / p.z; };
  float apart = length(vec2(a) - vec2(b));
  Search search;
  search.pixels = std::max(speed(a), speed(b));
  search.nearest = near;
  if (!(apart > found)) {  // one look in the middle
    search.nearest = 0.5f * (near + far);
    search.look = apart > same;
    return search;
  }
  search.steps = int(std::min(std::ceil(apart), float(most_steps)));
  search.step = (near - far) / float(search.steps);
  return search;
}

// Writes eight pixels from their words' lowest three bytes.
void write_rgb(const LaneBits& words, uint8_t* to, int count) {
  using b16 = uint8_t __attribute__((vector_size(16)));
  uint8_t bytes[2 * 12 + 4];
  uint8_t* at = count == lane_count ? to : bytes;
  for (const HalfLaneBits& four : {low_half(words), high_half(words)}) {
    b16 v = reinterpret_cast<const b16&>(four);
    v = __builtin_shufflevector(v, v, 0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, 3, 7, 11, 15);
    std::memcpy(at, &v, 12);
    at += 12;
  }
  if (count < lane_count) std::memcpy(to, bytes, size_t(count) * 3);
}

// Finds the first place on each of eight neighbours' epipolar lines that shows what the pixel would
// see, and its disparity. Returns which of the waiting pixels have none: they get the place of the
// farthest surface on their line, since that does not stand before what they would see.
LaneMask follow_line(const Source& source, const Place& base, const Search& search,
                     LaneMask waiting, Lanes& at_x, Lanes& at_y, Lanes& disparity) {
  const Mapping& m = source.to;
  at_x = at_y = disparity = Lanes{};
  const float candidate = search.step + found / std::max(search.pixels, 1e-30f);
  Lanes farthest = all_lanes(std::numeric_limits<float>::infinity()), behind_x{}, behind_y{};
  for (int i = 0; i <= search.steps && any_lane(waiting); i++) {
    const Lanes w = all_lanes(search.nearest - float(i) * search.step);
    const Place one = carry(m, base, w);
    const Lanes first = source.surface(one.x, one.y);
    const LaneMask farther = first < farthest;
    farthest = farther ? first : farthest;
    behind_x = farther ? one.x : behind_x, behind_y = farther ? one.y : behind_y;
    const LaneMask near = waiting & (lanes_abs(first - w) <= candidate);
    if (!any_lane(near)) continue;
    const Place two = carry(m, base, first);
    const Lanes second = source.surface(two.x, two.y);
    const Place three = carry(m, base, second);
    const LaneMask hit = near & (lanes_abs(second - first) * search.pixels <= meets);
    at_x = hit ? three.x : at_x, at_y = hit ? three.y : at_y;
    disparity = hit ? second : disparity;
    waiting &= ~hit;
  }
  at_x = waiting ? behind_x : at_x, at_y = waiting ? behind_y : at_y;
  return waiting;
}

// Returns the places, at disparity 0 and not yet divided by the ratio, of eight neighbours, the
// first of which has its middle at (x, y).
Place make_base(const Source& source, float x, float y) {
  const Mapping& m = source.to;
  const Lanes px = x + Lanes{0, 1, 2, 3, 4, 5, 6, 7};
  return {m.one.x + px * m.across.x + y * m.down.x, m.one.y + px * m.across.y + y * m.down.y,
          m.one.z + px * m.across.z + y * m.down.z};
}
LaneMask is_inside(const Source& source, const Lanes& x, const Lanes& y) {
  return (x >= -found) & (y >= -found) & (x <= source.last_x + (1 + found)) &
         (y <= source.last_y + (1 + found));
}

// Holds what a keyframe has for a row of eight pixels.
struct Row {
  LaneBits color{};    // colours of what it shows, or else of how it goes on
  Lanes disparity{};   // disparities of what it shows
  Lanes share{};       // share of the pixel that it covers, 0 to 1: less near its border
  LaneMask outside{};  // not within the keyframe, and not hidden by it
};
[[gnu::always_inline]] inline Row warp_row(const Source& source, float x, float y, LaneMask wanted,
                                           const Search& search) {
  const Mapping& m = source.to;
  const Place base = make_base(source, x, y);
  Row row;
  LaneMask hidden{};
  Lanes at_x, at_y;
  if (search.steps == 0) {
    // The middle disparity is right to half a pixel; after one look it is right to much less.
    row.disparity = all_lanes(search.nearest);
    Place place = carry(m, base, row.disparity);
    if (search.look) {
      row.disparity = source.surface(place.x, place.y);
      place = carry(m, base, row.disparity);
    }
    at_x = place.x, at_y = place.y;
  } else {
    hidden = follow_line(source, base, search, wanted, at_x, at_y, row.disparity);
  }
  const LaneMask inside = is_inside(source, at_x, at_y) & (base.ratio > least_depth);
  row.color = sample_color(source, at_x, at_y, source.coarse ? 0 : search.pixels);
  row.outside = wanted & ~inside & ~hidden;
  row.share = all_lanes(1);
  if (source.seam > 0) {
    const Lanes border = lanes_min(lanes_min(at_x, source.last_x + 1 - at_x),
                                   lanes_min(at_y, source.last_y + 1 - at_y));
    row.share = clamped(border * (1 / source.seam), 1);
  }
  row.share = keep_lanes(wanted & inside & ~hidden, row.share);
  return row;
}

struct Layer {
  Source source;
  const WarpBounds& bounds;
};

Search plan_block(const Layer& layer, const View& view, int bx, int by) {
  const int columns = (view.width + block - 1) / block, rows = (view.height + block - 1) / block;
  const size_t c = size_t(by) * size_t(columns) + size_t(bx);
  float far = layer.bounds.farthest[c], near = layer.bounds.nearest[c];
  if (near < 0) borrow_bounds(layer.bounds, columns, rows, bx, by, far, near);
  return plan_search(layer.source, (float(bx) + 0.5f) * block, (float(by) + 0.5f) * block, near,
                     far);
}

// Sums colours by their shares.
struct Mix {
  Lanes red{}, green{}, blue{}, left = all_lanes(1);
  void add(const LaneBits& color, const Lanes& share) {
    const Lanes part = share * left;
    red += part * to_float(color & 255u), green += part * to_float(color >> 8 & 255u),
        blue += part * to_float(color >> 16 & 255u);
    left -= part;
  }
  LaneBits color() const {
    return to_whole(red + 0.5f) | to_whole(green + 0.5f) << 8 | to_whole(blue + 0.5f) << 16;
  }
};

// Returns which of eight pixels a keyframe sees past at that disparity: nothing is there any more.
LaneMask sees_past(const Source& source, const Place& base, const Search& search,
                   const Lanes& disparity) {
  const Place place = carry(source.to, base, disparity);
  const Lanes there = source.surface(place.x, place.y);
  return is_inside(source, place.x, place.y) & ((disparity - there) * search.pixels > meets);
}

// Takes what the first keyframe does not fully show from the next ones, except for what the first
// one sees past; the remaining share goes on as the first does. Returns how many pixels lie outside
// of all.
int mix_row(std::span<const Layer> layers, const View& view, int x, int y, LaneMask wanted,
            const Search& search, const Row& first, LaneBits& color) {
  const float middle_x = float(x) + 0.5f, middle_y = float(y) + 0.5f;
  const Source& newest = layers[0].source;
  const Place base = make_base(newest, middle_x, middle_y);
  const LaneMask not_shown = first.share == 0.0f;
  Mix mix;
  mix.add(first.color, first.share);
  LaneMask outside = first.outside;
  for (const Layer& layer : layers.subspan(1)) {
    wanted &= mix.left > 0.0f;
    if (!any_lane(wanted)) break;
    const Row row = warp_row(layer.source, middle_x, middle_y, wanted,
                             plan_block(layer, view, x / block, y / block));
    const LaneMask gone = not_shown & sees_past(newest, base, search, row.disparity);
    mix.add(row.color, keep_lanes(~gone, row.share));
    outside &= row.outside;
  }
  mix.add(first.color, all_lanes(1));
  color = mix.color();
  return std::popcount(negative_lanes(outside));
}

// Draws the picture's rows of blocks from `begin` to `end`. Returns how many of their pixels lie
// outside of all keyframes.
int64_t warp_rows(std::span<const Layer> layers, const View& view, int begin, int end,
                  Image8& out) {
  int64_t outside = 0;
  const Layer& first = layers[0];
  for (int by = begin; by < end; by++)
    for (int x = 0; x < view.width; x += block) {
      const Search search = plan_block(first, view, x / block, by);
      const int count = std::min(view.width - x, block);
      const LaneMask wanted = LaneMask{0, 1, 2, 3, 4, 5, 6, 7} < count;
      for (int y = by * block; y < std::min((by + 1) * block, view.height); y++) {
        const Row row = warp_row(first.source, float(x) + 0.5f, float(y) + 0.5f, wanted, search);
        LaneBits color = row.color;
        if (any_lane(wanted & (row.share < 1.0f)))
          outside += mix_row(layers, view, x, y, wanted, search, row, color);
        write_rgb(color, &out.rgb[3 * (size_t(y) * size_t(view.width) + size_t(x))], count);
      }
    }
  return outside;
}

// Returns the share of the blocks that nothing was carried to.
float bare_share(const WarpBounds& bounds) {
  const auto bare = std::count(bounds.nearest.begin(), bounds.nearest.end(), -1.0f);
  return float(bare) / float(bounds.nearest.size());
}

}  // namespace

float warp_picture(std::span<const Keyframe* const> keyframes, const View& view, float most_unknown,
                   WarpScratch& scratch, Image8& out) {
  if (view.width < 1 || view.height < 1) return 1;
  std::vector<Layer> layers;
  if (scratch.bounds.size() < keyframes.size()) scratch.bounds.resize(keyframes.size());
  for (const Keyframe* keyframe : keyframes) {
    if (keyframe->empty()) continue;
    WarpBounds& bounds = scratch.bounds[layers.size()];
    const Source source(*keyframe, view);
    if (carry_bounds(source, view, bounds)) layers.push_back({source, bounds});
  }
  if (layers.empty()) return 1;
  for (size_t i = 0; i + 1 < layers.size(); i++)
    layers[i].source.seam = float(std::max(layers[i].source.k.view.width / seam_across, 1));
  if (const float share = bare_share(layers[0].bounds); layers.size() == 1 && share > most_unknown)
    return share;
  out.width = view.width;
  out.height = view.height;
  out.rgb.resize(size_t(view.width) * size_t(view.height) * 3);
  std::atomic<int64_t> outside{0};
  priority_ranges((view.height + block - 1) / block, 1,
                  [&](int begin, int end) { outside += warp_rows(layers, view, begin, end, out); });
  return float(outside) / (float(view.width) * float(view.height));
}

float warp_picture(const Keyframe& keyframe, const View& view, float most_unknown,
                   WarpScratch& scratch, Image8& out) {
  const Keyframe* const one[] = {&keyframe};
  return warp_picture(one, view, most_unknown, scratch, out);
}

float warp_picture(const Keyframe& keyframe, const Keyframe& around, const View& view,
                   float most_unknown, WarpScratch& scratch, Image8& out) {
  const Keyframe* const both[] = {&keyframe, &around};
  return warp_picture(both, view, most_unknown, scratch, out);
}

size_t memory_bytes(const WarpScratch& scratch) {
  size_t sum = bytes_of(scratch.bounds);
  for (const WarpBounds& one : scratch.bounds) sum += bytes_of(one.farthest, one.nearest);
  return sum;
}

}  // namespace wellspring::picture
