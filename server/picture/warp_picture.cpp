// SPDX-License-Identifier: Apache-2.0
#include "picture/warp_picture.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/memory.h"
#include "base/priority.h"
#include "picture/warp_source.h"

namespace wellspring {
namespace {

using namespace warping;
constexpr int block = Keyframe::block;
static_assert(block == lane_count);
constexpr int most_steps = 96;   // along an epipolar line
constexpr int most_blocks = 24;  // written per block, on average, when bounds are carried forward
constexpr int seam_across = 64;  // of its width, a keyframe passes into what is around
constexpr float found = 0.5f;    // pixels between a place and itself, carried there and back
constexpr float same = 0.125f;   // pixels between places of a block that one disparity stands for

// Bounds of disparities of every block of the new view, from the keyframe's blocks carried forward.
// False: they would move too far for that.
bool carry_bounds(const Source& source, const View& view, WarpScratch& scratch) {
  const Keyframe& k = source.k;
  const Mapping& m = source.back;
  int columns = (view.width + block - 1) / block, rows = (view.height + block - 1) / block;
  scratch.farthest.assign(size_t(columns) * size_t(rows), std::numeric_limits<float>::infinity());
  scratch.nearest.assign(scratch.farthest.size(), -1);
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
          scratch.farthest[c] = std::min(scratch.farthest[c], low);
          scratch.nearest[c] = std::max(scratch.nearest[c], high);
        }
    }
  return true;
}

// Bounds of a block that nothing was carried to: those around; at infinity where there are none.
void borrow_bounds(const WarpScratch& scratch, int columns, int rows, int bx, int by, float& far,
                   float& near) {
  far = std::numeric_limits<float>::infinity(), near = -1;
  for (int reach : {1, 4}) {
    for (int y = std::max(by - reach, 0); y <= std::min(by + reach, rows - 1); y++)
      for (int x = std::max(bx - reach, 0); x <= std::min(bx + reach, columns - 1); x++) {
        size_t c = size_t(y) * size_t(columns) + size_t(x);
        far = std::min(far, scratch.farthest[c]), near = std::max(near, scratch.nearest[c]);
      }
    if (near >= 0) return;
  }
  far = near = 0;
}

// Where eight neighbours' epipolar lines run, in steps of a pixel or less from the nearest to the
// farthest.
struct Search {
  float nearest = 0, step = 0;
  int steps = 0;
  bool look = true;  // without steps: the middle may be beside what is there
  float pixels = 0;  // a unit of disparity, at most
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

// Eight pixels from their words' lowest three bytes.
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

// The first of eight neighbours' epipolar lines' places that shows what the pixel would see; where
// something hides that, the farthest surface of the line.
void follow_line(const Source& source, const Place& base, const Search& search, LaneMask waiting,
                 Lanes& at_x, Lanes& at_y) {
  const Mapping& m = source.to;
  at_x = at_y = Lanes{};
  const float candidate = search.step + found / std::max(search.pixels, 1e-30f);
  Lanes farthest = all_lanes(std::numeric_limits<float>::infinity());
  for (int i = 0; i <= search.steps && any_lane(waiting); i++) {
    Lanes w = all_lanes(search.nearest - float(i) * search.step);
    Place one = carry(m, base, w);
    Lanes first = source.surface(one.x, one.y);
    LaneMask farther = waiting & (first < farthest);
    at_x = farther ? one.x : at_x, at_y = farther ? one.y : at_y;
    farthest = farther ? first : farthest;
    LaneMask near = waiting & (lanes_abs(first - w) <= candidate);
    if (!any_lane(near)) continue;
    Place two = carry(m, base, first);
    Lanes second = source.surface(two.x, two.y);
    Place three = carry(m, base, second);
    LaneMask hit = near & (lanes_abs(second - first) * search.pixels <= found);
    at_x = hit ? three.x : at_x, at_y = hit ? three.y : at_y;
    waiting &= ~hit;
  }
}

// What the pixels of a block's row are, as bits.
struct RowBits {
  uint8_t outside = 0;  // not within the keyframe
  uint8_t at_seam = 0;  // near its border
};
// `share`: how much of 255 the keyframe has in the pixels, written if any is not all its own. No
// more than `count`.
[[gnu::always_inline]] inline RowBits warp_row(const Source& source, float x, float y, int count,
                                               const Search& search, uint8_t* to, uint8_t* share) {
  const Mapping& m = source.to;
  Lanes px = x + Lanes{0, 1, 2, 3, 4, 5, 6, 7};
  Place base{m.one.x + px * m.across.x + y * m.down.x, m.one.y + px * m.across.y + y * m.down.y,
             m.one.z + px * m.across.z + y * m.down.z};
  Lanes at_x, at_y;
  if (search.steps ==
      0) {  // whatever lies in the middle is right to half a pixel, and then to much less
    Place place = carry(m, base, all_lanes(search.nearest));
    if (search.look) place = carry(m, base, source.surface(place.x, place.y));
    at_x = place.x, at_y = place.y;
  } else {
    follow_line(source, base, search, LaneMask{0, 1, 2, 3, 4, 5, 6, 7} < count, at_x, at_y);
  }
  write_rgb(sample_color(source, at_x, at_y, source.coarse ? 0 : search.pixels), to, count);
  LaneMask inside = (at_x >= -found) & (at_y >= -found) & (at_x <= source.last_x + (1 + found)) &
                    (at_y <= source.last_y + (1 + found)) & (base.ratio > least_depth);
  unsigned all = (1u << count) - 1;
  RowBits bits;
  bits.outside = uint8_t(negative_lanes(~inside) & all);
  if (!(source.seam > 0)) return bits;
  Lanes border = lanes_min(lanes_min(at_x, source.last_x + 1 - at_x),
                           lanes_min(at_y, source.last_y + 1 - at_y));
  LaneMask near = border < source.seam;
  if (!any_lane(near)) return bits;
  bits.at_seam = uint8_t(negative_lanes(near) & all & ~bits.outside);
  LaneMask shares = to_int(lanes_min(positive_lanes(border * (255 / source.seam)), all_lanes(255)));
  for (int i = 0; i < count; i++) share[i] = uint8_t(shares[i]);
  return bits;
}

// Calls warp(x, y, count, search) for every row of every block that wants(bx, by) it; (x, y): its
// first pixel.
template <class Wants, class Warp>
void each_row(const Source& source, const View& view, const WarpScratch& scratch,
              const Wants& wants, const Warp& warp) {
  int columns = (view.width + block - 1) / block, rows = (view.height + block - 1) / block;
  priority_ranges(rows, 1, [&](int begin, int end) {
    for (int by = begin; by < end; by++)
      for (int bx = 0; bx < columns; bx++) {
        if (!wants(bx, by)) continue;
        size_t c = size_t(by) * size_t(columns) + size_t(bx);
        float far = scratch.farthest[c], near = scratch.nearest[c];
        if (near < 0) borrow_bounds(scratch, columns, rows, bx, by, far, near);
        int x = bx * block, count = std::min(view.width - x, block);
        Search search =
            plan_search(source, float(x) + 0.5f * block, (float(by) + 0.5f) * block, near, far);
        for (int y = by * block; y < std::min((by + 1) * block, view.height); y++)
          warp(x, y, count, search);
      }
  });
}

uint8_t* pixel_at(Image8& image, int x, int y) {
  return &image.rgb[3 * (size_t(y) * size_t(image.width) + size_t(x))];
}

// What the keyframe does not show, and near its border what it does, is taken from `around`.
void warp_around(const Source& around, const View& view, WarpScratch& scratch, Image8& out) {
  const size_t columns = size_t((view.width + block - 1) / block);
  auto wants = [&](int bx, int by) {
    unsigned bits = 0;
    for (int y = by * block; y < std::min((by + 1) * block, view.height); y++) {
      size_t word = size_t(y) * columns + size_t(bx);
      bits |= scratch.outside[word] | scratch.at_seam[word];
    }
    return bits != 0;
  };
  each_row(around, view, scratch, wants, [&](int x, int y, int count, const Search& search) {
    size_t word = size_t(y) * columns + size_t(x / block);
    unsigned outside = scratch.outside[word], wanted = outside | scratch.at_seam[word];
    if (wanted == 0) return;
    uint8_t rgb[3 * block], no_share[block], *to = pixel_at(out, x, y);
    RowBits row = warp_row(around, float(x) + 0.5f, float(y) + 0.5f, count, search, rgb, no_share);
    size_t first = size_t(y) * size_t(view.width) + size_t(x);
    for (unsigned bits = wanted & ~row.outside; bits != 0; bits &= bits - 1) {
      int i = std::countr_zero(bits),
          share = outside >> i & 1 ? 0 : scratch.share[first + size_t(i)];
      for (int c = 3 * i; c < 3 * i + 3; c++)
        to[c] = uint8_t((to[c] * share + rgb[c] * (255 - share) + 127) / 255);
    }
    scratch.outside[word] = uint8_t(outside & row.outside);
  });
}

int count_bits(const std::vector<uint8_t>& words) {
  int sum = 0;
  for (uint8_t word : words) sum += std::popcount(word);
  return sum;
}

}  // namespace

float warp_picture(const Keyframe& keyframe, const View& view, float most_unknown,
                   WarpScratch& scratch, Image8& out) {
  return warp_picture(keyframe, Keyframe(), view, most_unknown, scratch, out);
}

float warp_picture(const Keyframe& keyframe, const Keyframe& around, const View& view,
                   float most_unknown, WarpScratch& scratch, Image8& out) {
  if (keyframe.empty() || view.width < 1 || view.height < 1) return 1;
  Source source(keyframe, view);
  if (!around.empty()) source.seam = float(std::max(keyframe.view.width / seam_across, 1));
  if (!carry_bounds(source, view, scratch)) return 1;
  size_t bare = size_t(std::count(scratch.nearest.begin(), scratch.nearest.end(), -1.0f));
  float share = float(bare) / float(scratch.nearest.size());
  if (share > most_unknown && around.empty()) return share;
  out.width = view.width;
  out.height = view.height;
  out.rgb.resize(size_t(view.width) * size_t(view.height) * 3);
  const size_t columns = size_t((view.width + block - 1) / block);
  scratch.outside.resize(columns * size_t(view.height));
  if (!around.empty()) {
    scratch.at_seam.resize(scratch.outside.size());
    scratch.share.resize(size_t(view.width) * size_t(view.height));
  }
  constexpr unsigned outside = 1, at_seam = 2;
  std::atomic<unsigned> bits{0};  // those of them that some pixel is
  auto all = [](int, int) { return true; };
  each_row(source, view, scratch, all, [&](int x, int y, int count, const Search& search) {
    size_t word = size_t(y) * columns + size_t(x / block);
    size_t first = size_t(y) * size_t(view.width) + size_t(x);
    RowBits row = warp_row(source, float(x) + 0.5f, float(y) + 0.5f, count, search,
                           pixel_at(out, x, y), around.empty() ? nullptr : &scratch.share[first]);
    scratch.outside[word] = row.outside;
    if (!around.empty()) scratch.at_seam[word] = row.at_seam;
    unsigned are = (row.outside ? outside : 0) | (row.at_seam ? at_seam : 0);
    if (are & ~bits.load(std::memory_order_relaxed)) bits |= are;
  });
  if (!around.empty() && bits != 0) {
    Source wide(around, view);
    if (carry_bounds(wide, view, scratch)) warp_around(wide, view, scratch, out);
  }
  if (!(bits & outside)) return 0;
  return float(count_bits(scratch.outside)) / (float(view.width) * float(view.height));
}

size_t memory_bytes(const WarpScratch& scratch) {
  return bytes_of(scratch.farthest, scratch.nearest, scratch.outside, scratch.at_seam,
                  scratch.share);
}

}  // namespace wellspring
