// SPDX-License-Identifier: Apache-2.0
#include "cache/attention.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <span>
#include <cmath>

#include "base/parallel.h"
#include "cache/packing.h"

namespace wellspring {
namespace {

constexpr float darkest_lit = 0.01f;  // reflectance that can tell of light, or show it
constexpr float same_facing = 0.9f;   // cosine
constexpr int change_ageing = 64;
constexpr int change_witnesses = 3;   // changed points in 3x3 tiles that make it a change
constexpr uint8_t changed_count = 2;  // samples a point near a change still vouches for

void age_tile(PointCache& points, const PointImage& image, StillImage& still, int tx, int ty) {
  int x1 = std::min((tx + 1) * change_tile, image.width),
      y1 = std::min((ty + 1) * change_tile, image.height);
  for (int y = ty * change_tile; y < y1; y++)
    for (int x = tx * change_tile; x < x1; x++) {
      size_t at = size_t(y) * size_t(image.width) + size_t(x);
      uint32_t point = image.point[at];
      if (at < still.count.size()) still.count[at] = 0;
      if (point == no_point || points.age[point] == evicted_age) continue;
      points.age[point] = uint8_t(std::min(points.age[point] + change_ageing, 254));
      points.count[point] = std::min(points.count[point], changed_count);
    }
}

// Counts the witnesses of each tile where they lie now: answers may be frames late, and the view has
// moved on.
void place_witnesses(const PointCache& points, const View& view, PointImage& image) {
  std::fill(image.changed.begin(), image.changed.end(), uint8_t(0));
  for (uint32_t i : image.witnesses) {
    if (i >= uint32_t(points.capacity()) || !is_alive(points, i)) continue;
    vec3 place(points.x[i], points.y[i], points.z[i]);
    if (points.flags[i] & point_infinite) place += view.position;
    Projected at = project_point(view, place);
    if (!(at.depth > 0 && at.x >= 0 && at.y >= 0 && at.x < float(image.width) && at.y < float(image.height)))
      continue;
    uint8_t& tile = image.changed[size_t(at.y) / change_tile * size_t(image.changed_width) +
                                  size_t(at.x) / change_tile];
    tile = uint8_t(std::min(tile + 1, 255));
  }
  image.witnesses.clear();
}

struct PixelPoint {
  uint32_t point = 0;
  int x = 0, y = 0;
};

// The light of the nearest of `newer` on the same surface. What depends on the view is taken to be as
// bright for its reflectance as there.
void borrow_light(PointCache& points, const PixelPoint& to, std::span<const PixelPoint> newer) {
  PointColor& mine = points.color[to.point];
  vec3 albedo = unpack_albedo(mine.albedo), normal = unpack_normal(mine.normal);
  if (max_component(albedo) < darkest_lit || (points.flags[to.point] & point_specular)) return;
  int nearest = 1 << 30;
  const PointColor* from = nullptr;
  for (const PixelPoint& one : newer) {
    int dx = one.x - to.x, dy = one.y - to.y, away = dx * dx + dy * dy;
    const PointColor& color = points.color[one.point];
    bool alike = color.object == mine.object && dot(unpack_normal(color.normal), normal) > same_facing &&
                 max_component(unpack_albedo(color.albedo)) >= darkest_lit;
    if (!alike || away >= nearest) continue;
    nearest = away;
    from = &color;
  }
  if (!from) return;
  float brighter = luminance(albedo) / std::max(luminance(unpack_albedo(from->albedo)), darkest_lit);
  mine.smooth = from->smooth;
  mine.rest = pack_rgb9e5(unpack_rgb9e5(from->rest) * brighter);
  mine.noise = 0;
}

using Levels = std::array<uint8_t, 256>;

// Not inlined: only as parameters of a real call do the pointers keep their promise not to overlap,
// and bytes might overlap anything. `around`: scratch of width + 2, its ends 0.
[[gnu::noinline]] void prioritise_empty(const uint32_t* __restrict above,
                                        const uint32_t* __restrict row,
                                        const uint32_t* __restrict below, int width,
                                        uint8_t* __restrict around, uint8_t* __restrict priority) {
  // Points in this column of the three rows.
  for (int x = 0; x < width; x++)
    around[x + 1] = uint8_t((above[x] != no_point) + (row[x] != no_point) + (below[x] != no_point));
  for (int x = 0; x < width; x++)
    priority[x] = uint8_t(255 - 14 * (around[x] + around[x + 1] + around[x + 2]));
}
// No branch: where there is no point, the first one is asked and its answer thrown away.
[[gnu::noinline]] void prioritise_points(const uint32_t* __restrict row,
                                         const uint8_t* __restrict ages,
                                         const uint8_t* __restrict counts, const Levels& by_age,
                                         const Levels& by_count, int width,
                                         uint8_t* __restrict priority) {
  for (int x = 0; x < width; x++) {
    uint32_t there = 0u - uint32_t(row[x] != no_point), point = row[x] & there;
    uint32_t known = uint32_t(by_age[ages[point]]) + by_count[counts[point]];
    priority[x] = uint8_t((priority[x] & ~there) | (known & there));
  }
}

}  // namespace

void age_changed(PointCache& points, const View& view, PointImage& image, StillImage& still) {
  if (image.witnesses.empty()) return;
  place_witnesses(points, view, image);
  int width = image.changed_width, height = image.changed_height;
  const std::vector<uint8_t>& changed = image.changed;
  parallel_ranges(height, 4, [&](int begin, int end) {
    for (int ty = begin; ty < end; ty++)
      for (int tx = 0; tx < width; tx++) {
        int near = 0;
        for (int y = std::max(ty - 1, 0); y <= std::min(ty + 1, height - 1); y++)
          for (int x = std::max(tx - 1, 0); x <= std::min(tx + 1, width - 1); x++)
            near += changed[size_t(y) * size_t(width) + size_t(x)];
        if (near >= change_witnesses) age_tile(points, image, still, tx, ty);
      }
  });
}

bool lend_light(PointCache& points, const PointImage& image) {
  std::atomic<bool> waits = false;
  parallel_ranges((image.height + lent_block - 1) / lent_block, 4, [&](int begin, int end) {
    PixelPoint relit[lent_block * lent_block], newer[lent_block * lent_block];
    for (int y = begin * lent_block; y < end * lent_block; y += lent_block)
      for (int x = 0; x < image.width; x += lent_block) {
        int relits = 0, newers = 0;
        for (int v = y; v < std::min(y + lent_block, image.height); v++)
          for (int u = x; u < std::min(x + lent_block, image.width); u++) {
            uint32_t point = image.point[size_t(v) * size_t(image.width) + size_t(u)];
            if (point == no_point) continue;
            if (points.flags[point] & point_relit) relit[relits++] = {point, u, v};
            else if (!(points.flags[point] & point_specular)) newer[newers++] = {point, u, v};
          }
        if (relits > 0) waits = true;
        for (int i = 0; i < relits; i++) borrow_light(points, relit[i], std::span(newer, size_t(newers)));
      }
  });
  return waits;
}

void prioritise(const PointCache& points, const CacheSettings& settings, PointImage& image) {
  int width = image.width, height = image.height;
  if (!settings.attention) {
    std::fill(image.priority.begin(), image.priority.end(), uint8_t(255));
    return;
  }
  Levels by_age{}, by_count{};
  for (int i = 0; i < 256; i++) {
    by_age[size_t(i)] =
        uint8_t(std::clamp(float(i) * 0.35f * settings.budget_share_old, 1.0f, 127.0f));
    by_count[size_t(i)] = uint8_t(30 / std::sqrt(float(std::max(i, 1))));
  }
  if (points.capacity() == 0) return;
  parallel_ranges(height, 8, [&](int begin, int end) {
    thread_local std::vector<uint8_t> around;
    around.assign(size_t(width) + 2, 0);
    thread_local std::vector<uint32_t> blank;
    blank.assign(size_t(width), no_point);
    for (int y = begin; y < end; y++) {
      const uint32_t* row = image.point.data() + size_t(y) * size_t(width);
      uint8_t* priority = image.priority.data() + size_t(y) * size_t(width);
      prioritise_empty(y > 0 ? row - width : blank.data(), row,
                       y + 1 < height ? row + width : blank.data(), width, around.data(), priority);
      prioritise_points(row, points.age.data(), points.count.data(), by_age, by_count, width,
                        priority);
    }
  });
}

}  // namespace wellspring
