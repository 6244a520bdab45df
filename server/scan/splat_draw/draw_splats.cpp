// SPDX-License-Identifier: Apache-2.0
#include "scan/splat_draw/draw_splats.h"

#include <algorithm>
#include <limits>

#include "base/memory.h"
#include "base/parallel.h"
#include "scan/splat_draw/draw_lanes.h"

namespace wellspring::scan {
namespace {

constexpr size_t keys_a_count = 2048;
constexpr uint64_t most_entries = 3 << 20;  // in tiles' lists at a time
constexpr int tile_pixels = tile_stride * tile_height;
constexpr float infinite = std::numeric_limits<float>::infinity();

// Tiles that a splat may touch.
uint64_t count_tiles(const PixelBox& box) {
  return uint64_t(box.right / tile_width - box.left / tile_width + 1) *
         uint64_t(box.bottom / tile_height - box.top / tile_height + 1);
}

// Copies one over the surface's depths of a tile; returns the least.
float copy_surface(float* to, std::span<const float> surface, int width, int height, int x, int y) {
  float least = infinite;
  for (int row = 0; row < tile_height; row++)
    for (int i = 0; i < tile_stride; i++) {
      float nearness = 0;
      if (row + y < height && i + x < width && i < tile_width) {
        const float depth = surface[size_t(row + y) * size_t(width) + size_t(i + x)];
        nearness = depth > 0 ? 1 / depth : 0;
        least = std::min(least, nearness);
      }
      to[row * tile_stride + i] = nearness;
    }
  return least;
}

void begin_tile(SplatTile& tile, int columns, int rows) {
  std::fill_n(&tile.color[0][0], 3 * tile_pixels, 0.0f);
  std::fill_n(tile.nearness, tile_pixels, 0.0f);
  std::fill_n(tile.clear, tile_pixels, 0.0f);
  for (int row = 0; row < std::min(rows, tile_height); row++)
    std::fill_n(tile.clear + row * tile_stride, std::min(columns, tile_width), 1.0f);
}

void finish_tile(SplatPlanes& picture, const SplatTile& tile, int x, int y) {
  for (int row = 0; row < std::min(tile_height, picture.height - y); row++)
    for (int i = 0; i < std::min(tile_width, picture.width - x); i += lane_count) {
      const int at = row * tile_stride + i, count = std::min(lane_count, picture.width - x - i);
      const size_t to = size_t(y + row) * size_t(picture.width) + size_t(x + i);
      Lanes3 light;
      light.x = decode_display(load_lanes(&tile.color[0][at]));
      light.y = decode_display(load_lanes(&tile.color[1][at]));
      light.z = decode_display(load_lanes(&tile.color[2][at]));
      for (int lane = 0; lane < count; lane++) picture.light[to + size_t(lane)] = light.at(lane);
      for (int lane = 0; lane < count; lane++) {
        picture.clear[to + size_t(lane)] = tile.clear[at + lane];
        picture.depth[to + size_t(lane)] = 1 / tile.nearness[at + lane];
      }
    }
}

}  // namespace

SplatTilePlace SplatDrawer::place_of(const SplatGrid& grid, int tile) const {
  return {tile % grid.across * tile_width, tile / grid.across * tile_height,
          surface_.empty() ? nullptr : surface_.data() + size_t(tile) * tile_pixels};
}

// Draws some splats after the others, so tiles in which nothing more is seen get no more lists.
void SplatDrawer::draw_in_order(const SplatGrid& grid) {
  const std::span<const DrawnKey> keys = drawn_.keys;
  std::vector<uint64_t> entries((keys.size() + keys_a_count - 1) / keys_a_count);
  parallel_ranges(int(entries.size()), 4, [&](int begin, int end) {
    for (size_t i = size_t(begin) * keys_a_count;
         i < std::min(keys.size(), size_t(end) * keys_a_count); i++)
      entries[i / keys_a_count] += count_tiles(boxes_[i]);
  });
  for (size_t begin = 0; begin < entries.size();) {
    size_t end = begin;
    for (uint64_t sum = 0;
         end < entries.size() && (end == begin || sum + entries[end] <= most_entries);)
      sum += entries[end++];
    const size_t first = begin * keys_a_count, last = std::min(keys.size(), end * keys_a_count);
    list_splats(lists_, drawn_, keys.subspan(first, last - first),
                std::span(boxes_).subspan(first, last - first), grid, limits_, 0, grid.down);
    parallel_ranges(grid.count(), 1, [&](int from, int to) {
      for (int tile = from; tile < to; tile++) {
        const auto list = lists_.of(tile);
        if (!list.empty() &&
            blend_in_order(tiles_[size_t(tile)], drawn_, list, place_of(grid, tile)))
          limits_[size_t(tile)] = infinite;
      }
    });
    begin = end;
    if (std::all_of(limits_.begin(), limits_.end(), [](float l) { return l == infinite; })) break;
  }
}

// Draws some rows of tiles after the others, since pixels hold back splats.
void SplatDrawer::draw_by_pixel(const SplatGrid& grid) {
  std::vector<uint64_t> entries(size_t(grid.down));
  for (const PixelBox& box : boxes_)
    for (int row = box.top / tile_height; row <= box.bottom / tile_height; row++)
      entries[size_t(row)] += uint64_t(box.right / tile_width - box.left / tile_width + 1);
  for (int begin = 0; begin < grid.down;) {
    int end = begin;
    for (uint64_t sum = 0;
         end < grid.down && (end == begin || sum + entries[size_t(end)] <= most_entries);)
      sum += entries[size_t(end++)];
    list_splats(lists_, drawn_, drawn_.keys, boxes_, grid, limits_, begin, end);
    parallel_each((end - begin) * grid.across, [&](int i) {
      const int tile = begin * grid.across + i;
      blend_by_pixel(tiles_[size_t(tile)], drawn_, lists_.of(tile), place_of(grid, tile));
    });
    begin = end;
  }
}

void SplatDrawer::draw(SplatPlanes& picture, std::span<const PlacedSplats> sets,
                       const ScanCamera& view, const SplatDrawing& settings) {
  ProjectSettings project = settings.project;
  project.nearest_first = settings.by_pixel;
  project_splats(drawn_, sets, view, project);
  sort_by_depth(drawn_.keys, spare_);
  boxes_.resize(drawn_.keys.size());
  parallel_ranges(int(boxes_.size()), 4096, [&](int begin, int end) {
    const DrawnKey* keys = drawn_.keys.data();
    for (int i = begin; i < end; i++) {
      if (i + 16 < end) __builtin_prefetch(&drawn_.boxes[keys[i + 16].number]);
      boxes_[size_t(i)] = drawn_.boxes[keys[i].number];
    }
  });

  const SplatGrid grid(view.width, view.height);
  tiles_.resize(size_t(grid.count()));
  limits_.assign(size_t(grid.count()), 0);
  surface_.resize(settings.surface.empty() ? 0 : size_t(grid.count()) * tile_pixels);
  parallel_ranges(grid.count(), 8, [&](int begin, int end) {
    for (int tile = begin; tile < end; tile++) {
      const SplatTilePlace at = place_of(grid, tile);
      begin_tile(tiles_[size_t(tile)], view.width - at.x, view.height - at.y);
      if (!surface_.empty())
        limits_[size_t(tile)] = copy_surface(surface_.data() + size_t(tile) * tile_pixels,
                                             settings.surface, view.width, view.height, at.x, at.y);
    }
  });
  if (settings.by_pixel) draw_by_pixel(grid);
  else draw_in_order(grid);

  const size_t pixels = size_t(view.width) * size_t(view.height);
  picture.width = view.width, picture.height = view.height;
  picture.light.resize(pixels);
  picture.clear.resize(pixels);
  picture.depth.resize(pixels);
  picture.looked_at = drawn_.looked_at, picture.drawn = int64_t(drawn_.keys.size());
  parallel_ranges(grid.count(), 8, [&](int begin, int end) {
    for (int tile = begin; tile < end; tile++) {
      const SplatTilePlace at = place_of(grid, tile);
      finish_tile(picture, tiles_[size_t(tile)], at.x, at.y);
    }
  });
}

size_t SplatDrawer::memory_bytes() const {
  return bytes_of(drawn_.splats, drawn_.boxes, drawn_.keys, spare_, boxes_, lists_.first,
                  lists_.splats, tiles_, surface_, limits_);
}

void lay_over(std::span<vec3> linear, const SplatPlanes& picture, float exposure) {
  parallel_ranges(int(linear.size() / lane_count) + 1, 1024, [&](int begin, int end) {
    for (int i = begin; i < end; i++) {
      const size_t at = size_t(i) * lane_count;
      const int count = int(std::min<size_t>(lane_count, linear.size() - at));
      Lanes3 light, behind;
      Lanes clear{};
      for (int lane = 0; lane < count; lane++) {
        light.set(lane, picture.light[at + size_t(lane)]);
        behind.set(lane, linear[at + size_t(lane)]);
        clear[lane] = picture.clear[at + size_t(lane)];
      }
      const auto blend = [&](const Lanes& over, const Lanes& under) {
        const Lanes codes = encode_display(over) + clear * encode_display(under * exposure);
        // Pixels that nothing covers stay as they are.
        return clear >= 1.0f ? under : decode_display(codes) * (1 / exposure);
      };
      const Lanes3 sum{blend(light.x, behind.x), blend(light.y, behind.y),
                       blend(light.z, behind.z)};
      for (int lane = 0; lane < count; lane++) linear[at + size_t(lane)] = sum.at(lane);
    }
  });
}

}  // namespace wellspring::scan
