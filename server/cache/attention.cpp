// SPDX-License-Identifier: Apache-2.0
#include "cache/attention.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <span>

#include "base/parallel.h"
#include "cache/packing.h"

namespace wellspring::cache {
namespace {

constexpr float darkest_lit = 0.01f;  // least reflectance that light is lent from or to
constexpr float same_facing = 0.9f;   // cosine
// Age that is added to points near places where the light seems to have changed: little enough that
// places without change samples are asked for, too.
constexpr int change_ageing = 32;
// Light has changed in a tile if the change samples of 3x3 tiles agree that it did: their sum is
// off by this many standard deviations, and by this much on average. Each sample counts its own
// size or its known noise, whichever is more (a self-normalised sum: rare bright samples neither
// make a change nor hide one for long; Pena, Lai, Shao 2009).
struct ChangeTest {
  float deviations, least_change;
};
constexpr ChangeTest beyond_doubt{5, 0.15f};
// If one thing has changed, another may well have: for this many pictures a smaller change
// suffices, over more change samples.
constexpr ChangeTest likely{3, 0.05f};
constexpr int alarm_pictures = 45;

// Forgets the light of a point at which it has changed, unless the point is new: then it has seen
// the new light already.
void invalidate_old_light(PointCache& points, uint32_t i) {
  if ((points.flags[i] & point_relit) || (points.age[i] == 0 && points.count[i] == 1)) return;
  invalidate_light_of(points, i, change_ageing);
}

void age_tile(PointCache& points, PointImage& image, int tx, int ty) {
  int x1 = std::min((tx + 1) * change_tile, image.width),
      y1 = std::min((ty + 1) * change_tile, image.height);
  for (int y = ty * change_tile; y < y1; y++)
    for (int x = tx * change_tile; x < x1; x++) {
      size_t at = size_t(y) * size_t(image.width) + size_t(x);
      uint32_t point = image.point[at];
      image.renewed[at] = 1;
      if (point != no_point) invalidate_old_light(points, point);
    }
}

// Returns the tile where a change sample lies now, or -1: answers may be frames late, and the view
// has moved on.
int tile_of(const PointCache& points, const View& view, const PointImage& image, uint32_t i) {
  if (i >= uint32_t(points.capacity()) || !is_alive(points, i)) return -1;
  vec3 place(points.x[i], points.y[i], points.z[i]);
  if (points.flags[i] & point_infinite) place += view.position;
  Projected at = project_point(view, place);
  if (!(at.depth > 0 && at.x >= 0 && at.y >= 0 && at.x < float(image.width) &&
        at.y < float(image.height)))
    return -1;
  return int(at.y) / change_tile * image.changed_width + int(at.x) / change_tile;
}

// Forgets the light of hidden points in tiles that have changed, since they may be the nearest ones
// in the next picture.
void age_hidden(PointCache& points, const View& view, const PointImage& image,
                const std::vector<uint8_t>& verdict) {
  parallel_ranges(points.capacity(), 1 << 14, [&](int begin, int end) {
    for (uint32_t i = uint32_t(begin); i < uint32_t(end); i++) {
      if (points.flags[i] & (point_visible | point_relit)) continue;
      int tile = tile_of(points, view, image, i);
      if (tile >= 0 && verdict[size_t(tile)]) invalidate_old_light(points, i);
    }
  });
}

void place_change_samples(const PointCache& points, const View& view, PointImage& image,
                          std::vector<int>& tiles) {
  std::fill(image.changed.begin(), image.changed.end(), TileChange{});
  tiles.resize(image.change_samples.size());
  for (size_t i = 0; i < tiles.size(); i++) {
    const ChangeSample& change_sample = image.change_samples[i];
    tiles[i] = tile_of(points, view, image, change_sample.point);
    if (tiles[i] < 0) continue;
    TileChange& tile = image.changed[size_t(tiles[i])];
    tile.change += change_sample.change;
    tile.square += std::max(change_sample.change * change_sample.change,
                            change_sample.noise * change_sample.noise);
    tile.count++;
  }
}

void add(TileChange& sum, const TileChange& tile) {
  sum.change += tile.change;
  sum.square += tile.square;
  sum.count += tile.count;
}

bool proves(const TileChange& sum, const ChangeTest& change_test) {
  return sum.change * sum.change > change_test.deviations * change_test.deviations * sum.square &&
         std::abs(sum.change) > change_test.least_change * float(sum.count);
}

bool has_changed(const PointImage& image, int tx, int ty, const ChangeTest& change_test) {
  TileChange sum;
  for (int y = std::max(ty - 1, 0); y <= std::min(ty + 1, image.changed_height - 1); y++)
    for (int x = std::max(tx - 1, 0); x <= std::min(tx + 1, image.changed_width - 1); x++)
      add(sum, image.changed[size_t(y) * size_t(image.changed_width) + size_t(x)]);
  return proves(sum, change_test);
}

// Returns whether a change is beyond doubt in any square of 2, 4, 8 ... tiles a side. If samples
// are noisy or the change is small, it takes many tiles to prove it.
bool has_changed_widely(const PointImage& image) {
  std::vector<TileChange> tiles = image.changed, wider;
  for (int width = image.changed_width, height = image.changed_height; width > 1 || height > 1;) {
    int half_width = (width + 1) / 2, half_height = (height + 1) / 2;
    wider.assign(size_t(half_width) * size_t(half_height), TileChange{});
    for (int y = 0; y < height; y++)
      for (int x = 0; x < width; x++)
        add(wider[size_t(y / 2) * size_t(half_width) + size_t(x / 2)],
            tiles[size_t(y) * size_t(width) + size_t(x)]);
    if (std::any_of(wider.begin(), wider.end(),
                    [](const TileChange& sum) { return proves(sum, beyond_doubt); }))
      return true;
    std::swap(tiles, wider);
    width = half_width, height = half_height;
  }
  return false;
}

struct PixelPoint {
  uint32_t point = 0;
  int x = 0, y = 0;
};

// Gives a point the light of the nearest of `newer` on the same surface. Light that depends on the
// view is scaled with the luminance of the reflectance.
void borrow_light(PointCache& points, const PixelPoint& to, std::span<const PixelPoint> newer) {
  PointColor& mine = points.color[to.point];
  vec3 albedo = unpack_albedo(mine.albedo), normal = unpack_normal(mine.normal);
  if (max_component(albedo) < darkest_lit || (points.flags[to.point] & point_specular)) return;
  int nearest = 1 << 30;
  const PointColor* from = nullptr;
  for (const PixelPoint& one : newer) {
    int dx = one.x - to.x, dy = one.y - to.y, away = dx * dx + dy * dy;
    const PointColor& color = points.color[one.point];
    bool alike = color.object == mine.object &&
                 dot(unpack_normal(color.normal), normal) > same_facing &&
                 max_component(unpack_albedo(color.albedo)) >= darkest_lit;
    if (!alike || away >= nearest) continue;
    nearest = away;
    from = &color;
  }
  if (!from) return;
  float brighter =
      luminance(albedo) / std::max(luminance(unpack_albedo(from->albedo)), darkest_lit);
  mine.smooth = from->smooth;
  mine.rest = pack_rgb9e5(unpack_rgb9e5(from->rest) * brighter);
  points.count[to.point] = 1;
}

using Levels = std::array<uint8_t, 256>;

// This is not inlined: only as parameters of a real call do the pointers keep their promise not to
// overlap, and bytes might overlap anything. `around`: scratch of width + 2, its ends 0.
[[gnu::noinline]] void prioritise_empty(const uint32_t* __restrict above,
                                        const uint32_t* __restrict row,
                                        const uint32_t* __restrict below, int width,
                                        uint8_t* __restrict around, uint8_t* __restrict priority) {
  // `around` counts the points in this column of the three rows.
  for (int x = 0; x < width; x++)
    around[x + 1] = uint8_t((above[x] != no_point) + (row[x] != no_point) + (below[x] != no_point));
  for (int x = 0; x < width; x++)
    priority[x] = uint8_t(255 - 14 * (around[x] + around[x + 1] + around[x + 2]));
}
// There is no branch: a pixel without a point looks up point 0, and the answer is thrown away.
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

// Returns the weight of the object at the first pixel with a point, counted from pixel `turn` of
// the cell.
uint8_t weight_of_cell(const PointCache& points, std::span<const uint8_t> of_object, uint32_t turn,
                       const PointImage& image, int x, int y) {
  const int width = std::min(weight_cell, image.width - x),
            height = std::min(weight_cell, image.height - y), count = width * height;
  for (int i = 0, k = int(turn % uint32_t(count)); i < count; i++, k = k + 1 < count ? k + 1 : 0) {
    size_t at = size_t(y + k / width) * size_t(image.width) + size_t(x + k % width);
    if (image.point[at] == no_point) continue;
    uint32_t object = points.color[image.point[at]].object;
    return object < of_object.size() ? of_object[object] : uint8_t(weight_one);
  }
  return weight_one;
}

}  // namespace

bool age_changed(PointCache& points, const View& view, PointImage& image) {
  image.alarm = std::max(image.alarm - 1, 0);
  if (image.change_samples.empty()) return false;
  keep_newest_change_samples(image);
  std::vector<int> tiles;
  place_change_samples(points, view, image, tiles);
  const ChangeTest& change_test = image.alarm > 0 ? likely : beyond_doubt;
  std::vector<uint8_t> verdict(image.changed.size(), 0);
  parallel_ranges(image.changed_height, 4, [&](int begin, int end) {
    for (int ty = begin; ty < end; ty++)
      for (int tx = 0; tx < image.changed_width; tx++) {
        if (!has_changed(image, tx, ty, change_test)) continue;
        verdict[size_t(ty) * size_t(image.changed_width) + size_t(tx)] = 1;
        age_tile(points, image, tx, ty);
      }
  });
  // A change counts only once, and one that is not in view now may be undone when it is again.
  size_t kept = 0;
  for (size_t i = 0; i < tiles.size(); i++)
    if (tiles[i] >= 0 && !verdict[size_t(tiles[i])])
      image.change_samples[kept++] = image.change_samples[i];
  image.change_samples.resize(kept);
  if (image.change_samples.capacity() > 2 * kept + 4096)
    image.change_samples.shrink_to_fit();  // after many at once
  bool changed =
      std::any_of(verdict.begin(), verdict.end(), [](uint8_t aged) { return aged != 0; });
  if (changed) age_hidden(points, view, image, verdict);
  if (image.alarm == 0 && (changed || has_changed_widely(image))) image.alarm = alarm_pictures;
  return changed;
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
        for (int i = 0; i < relits; i++)
          borrow_light(points, relit[i], std::span(newer, size_t(newers)));
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

void weigh(const PointCache& points, std::span<const uint8_t> of_object, uint32_t turn,
           PointImage& image) {
  image.weight.clear();
  if (of_object.empty()) return;
  const int columns = weight_cells(image.width), rows = weight_cells(image.height);
  image.weight.resize(size_t(columns) * size_t(rows));
  parallel_ranges(rows, 8, [&](int begin, int end) {
    for (int row = begin; row < end; row++)
      for (int column = 0; column < columns; column++)
        image.weight[size_t(row) * size_t(columns) + size_t(column)] =
            weight_of_cell(points, of_object, turn, image, column * weight_cell, row * weight_cell);
  });
}

}  // namespace wellspring::cache
