// SPDX-License-Identifier: Apache-2.0
#include "warp_and_splat.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstring>

#include "base/parallel.h"
#include "fine_normal.h"
#include "level_lanes.h"

namespace wellspring::test {
namespace {

constexpr int tile_width = 64, tile_height = 32;
constexpr int tile_stride = tile_width + lane_count;  // eight lanes may begin at the last pixel
constexpr int chunk_samples = 4096;
// factor of the footprints' size: few old samples cover no whole picture
constexpr float most_growth = 4;
constexpr float other_side = 0.05f;  // cosine by which a (shading) normal may point away

// 4 bits of level, 28 of nearness: the bits of a positive float have its order, their last 3 are
// finer than what is known of a sample's place.
constexpr int level_shift = 28, depth_cut = 3;
constexpr uint32_t most_nearness = (1u << level_shift) - 1;
static_assert(most_sqrt5_levels < 16);

struct Tiles {
  int x, y;
  int count() const { return x * y; }
};

// Everything a sample needs to find its pixels.
struct Warp {
  Lanes3 eye, right, up, forward;
  float focal, axis_x, axis_y;  // pixels
  int width, height;
};

LaneMask floor_lanes(const Lanes& a) {
  LaneMask whole = lanes_as<LaneMask>(to_whole(a));
  return whole + (__builtin_convertvector(whole, Lanes) > a);  // the answer of > is -1
}
LaneMask clamp_lanes(const LaneMask& a, int low, int high) {
  LaneMask l = LaneMask{} + low, h = LaneMask{} + high;
  LaneMask up = a > l ? a : l;
  return up < h ? up : h;
}

// Returns how many splats were written.
uint32_t warp_piece(const Warp& warp, const SplatScratch::Piece& piece, int level_side,
                    Splat* splats) {
  const LevelSamples& list = *piece.list;
  uint32_t written = 0;
  const float side_now = float(level_side) * warp.focal,
              most_side = most_growth * float(level_side);
  const uint32_t level_bits = uint32_t(piece.level) << level_shift;
  for (int i = piece.begin; i < piece.begin + piece.count; i += lane_count) {
    int here = std::min(lane_count, piece.begin + piece.count - i);
    Lanes3 d = load_places(list, i, here) - warp.eye;
    Lanes depth = dot(d, warp.forward), share = 1.0f / depth, scale = warp.focal * share;
    Lanes x = dot(d, warp.right) * scale + warp.axis_x;
    Lanes y = warp.axis_y - dot(d, warp.up) * scale;
    Lanes width = load_some(&list.width[size_t(i)], here);
    Lanes wide = lanes_min(lanes_max(width * share * side_now, all_lanes(1)), all_lanes(most_side));
    Lanes3 normal = unpack_fine_normal(load_some<LaneBits>(&list.normal[size_t(i)], here));
    Lanes away = dot(normal, d);
    away = load_some(&list.facing[size_t(i)], here) < 0.0f ? -away : away;
    // Comparisons with NaN are false. Nothing outside of these bounds reaches the picture.
    LaneMask good = (depth > 0.0f) & (away <= other_side * depth) & (x > -most_side) &
                    (y > -most_side) & (x < float(warp.width) + most_side) &
                    (y < float(warp.height) + most_side);
    unsigned bits = negative_lanes(good) & ((1u << here) - 1);
    if (bits == 0) continue;
    x = keep_lanes(good, x), y = keep_lanes(good, y), wide = keep_lanes(good, wide);
    LaneMask side = round_lanes(wide), before = (side - 1) >> 1;
    LaneMask left = floor_lanes(x) - before, top = floor_lanes(y) - before;
    LaneMask x0 = clamp_lanes(left, 0, warp.width), x1 = clamp_lanes(left + side, 0, warp.width);
    LaneMask y0 = clamp_lanes(top, 0, warp.height), y1 = clamp_lanes(top + side, 0, warp.height);
    bits &= negative_lanes((x0 < x1) & (y0 < y1));
    LaneBits key = level_bits | (most_nearness - (lanes_as<LaneBits>(depth) >> depth_cut));
    for (; bits != 0; bits &= bits - 1) {
      int k = std::countr_zero(bits);
      splats[written++] = {uint16_t(x0[k]),          uint16_t(y0[k]), uint16_t(x1[k]),
                           uint16_t(y1[k]),          key[k],          piece.object,
                           list.words[size_t(i + k)]};
    }
  }
  return written;
}

// The tiles that a splat touches: body(tile).
template <class Body>
void each_tile(const Splat& splat, const Tiles& tiles, const Body& body) {
  int left = splat.x0 / tile_width, right = (splat.x1 - 1) / tile_width;
  int top = splat.y0 / tile_height, bottom = (splat.y1 - 1) / tile_height;
  for (int y = top; y <= bottom; y++)
    for (int x = left; x <= right; x++) body(size_t(y * tiles.x + x));
}

void sort_by_tile(const Splat* splats, const Tiles& tiles, SplatScratch::Chunk& chunk) {
  std::vector<uint32_t>& begin = chunk.tile_begin;
  begin.assign(size_t(tiles.count()) + 2, 0);  // counts two places on, so that begins end up right
  for (uint32_t i = 0; i < chunk.splat_count; i++)
    each_tile(splats[i], tiles, [&](size_t tile) { begin[tile + 2]++; });
  for (size_t t = 2; t < begin.size(); t++) begin[t] += begin[t - 1];
  chunk.entries.resize(begin.back());
  for (uint32_t i = 0; i < chunk.splat_count; i++)
    each_tile(splats[i], tiles,
              [&](size_t tile) { chunk.entries[begin[tile + 1]++] = chunk.first_splat + i; });
}

// Samples in pieces, pieces in chunks. Returns how many samples.
int cut_into_chunks(const SampleStore& store, SplatScratch& scratch) {
  size_t chunks = 0;
  uint32_t samples = 0, room = 0;
  scratch.pieces.clear();
  for (const ObjectSamples& object : store.objects)
    for (size_t level = 0; level < object.levels.size(); level++) {
      const LevelSamples& list = object.levels[level];
      for (int begin = 0; begin < list.count();) {
        if (room == 0) {
          if (scratch.chunks.size() == chunks) scratch.chunks.emplace_back();
          SplatScratch::Chunk& next = scratch.chunks[chunks++];
          next.first_list = uint32_t(scratch.pieces.size());
          next.first_splat = samples;
          next.list_count = next.splat_count = 0;
          room = chunk_samples;
        }
        int count = std::min(list.count() - begin, int(room));
        scratch.pieces.push_back({&list, object.object, int(level) + 1, begin, count});
        scratch.chunks[chunks - 1].list_count++;
        begin += count;
        samples += uint32_t(count);
        room -= uint32_t(count);
      }
    }
  scratch.chunks.resize(chunks);
  scratch.splats.resize(samples);
  return int(samples);
}

// The pixels of a tile while its splats are drawn.
struct TilePixels {
  alignas(64) uint32_t object[tile_height * tile_stride];
  alignas(64) uint32_t key[tile_height * tile_stride];
  alignas(64) uint32_t splat[tile_height * tile_stride];
};

void draw_splat(const Splat& splat, uint32_t index, int left, int top, TilePixels& pixels) {
  int x0 = std::max(splat.x0 - left, 0), x1 = std::min(splat.x1 - left, tile_width);
  int y0 = std::max(splat.y0 - top, 0), y1 = std::min(splat.y1 - top, tile_height);
  if (x1 - x0 == 1 && y1 - y0 == 1) {
    size_t at = size_t(y0 * tile_stride + x0);
    if (pixels.object[at] != splat.object || pixels.key[at] > splat.key) return;
    pixels.key[at] = splat.key;
    pixels.splat[at] = index;
    return;
  }
  constexpr LaneMask number{0, 1, 2, 3, 4, 5, 6, 7};
  for (int x = x0; x < x1; x += lane_count) {
    LaneMask inside = number < (x1 - x);
    for (int y = y0; y < y1; y++) {
      size_t at = size_t(y * tile_stride + x);
      LaneBits key = load_lanes<LaneBits>(pixels.key + at);
      LaneMask shown =
          inside & (load_lanes<LaneBits>(pixels.object + at) == splat.object) & (key <= splat.key);
      store_lanes(pixels.key + at, shown ? all_lane_bits(splat.key) : key);
      LaneBits old = load_lanes<LaneBits>(pixels.splat + at);
      store_lanes(pixels.splat + at, shown ? all_lane_bits(index) : old);
    }
  }
}

// A row of a tile into the planes; returns how many pixels show a sample.
int write_row(const uint32_t* key, const uint32_t* splat, const Splat* splats, int columns,
              SampleWords* __restrict words, uint8_t* __restrict level) {
  int shown = 0;
  for (int x = 0; x < columns; x++) level[x] = uint8_t(key[x] >> level_shift);
  for (int x = 0; x < columns; x++) {
    if (key[x] == 0) continue;
    words[x] = splats[splat[x]].words;
    shown++;
  }
  return shown;
}

}  // namespace

SplatStats warp_and_splat(const SampleStore& store, const View& view,
                          std::span<const uint32_t> object, SplatScratch& scratch,
                          std::span<SampleWords> words, std::span<uint8_t> level) {
  SplatStats stats;
  stats.samples = cut_into_chunks(store, scratch);
  if (stats.samples == 0) {
    std::fill(level.begin(), level.end(), uint8_t(0));
    return stats;
  }
  const Tiles tiles{(view.width + tile_width - 1) / tile_width,
                    (view.height + tile_height - 1) / tile_height};
  const vec2 axis = axis_place(view);
  const Warp warp{all_lanes(view.position),
                  all_lanes(view.right),
                  all_lanes(view.up),
                  all_lanes(view.forward),
                  float(view.height) * 0.5f / view.tan_half_fov,
                  axis.x,
                  axis.y,
                  view.width,
                  view.height};

  // Pass 1: warp, then sort each chunk's splats by tile.
  std::atomic<int> splats = 0, pixels = 0;
  parallel_for(int(scratch.chunks.size()), [&](int c) {
    SplatScratch::Chunk& chunk = scratch.chunks[size_t(c)];
    Splat* out = scratch.splats.data() + chunk.first_splat;
    for (uint32_t i = 0; i < chunk.list_count; i++) {
      const SplatScratch::Piece& piece = scratch.pieces[chunk.first_list + i];
      int side = footprint_side(store.grid, piece.level);
      chunk.splat_count += warp_piece(warp, piece, side, out + chunk.splat_count);
    }
    sort_by_tile(out, tiles, chunk);
    splats += int(chunk.splat_count);
  });

  // Pass 2: tile by tile, the samples in the order of chunks.
  parallel_ranges(tiles.count(), 2, [&](int begin, int end) {
    TilePixels tile_pixels;
    int shown = 0;
    for (int tile = begin; tile < end; tile++) {
      int left = tile % tiles.x * tile_width, top = tile / tiles.x * tile_height;
      int columns = std::min(tile_width, view.width - left);
      int rows = std::min(tile_height, view.height - top);
      auto at = [&](int y) { return size_t(top + y) * size_t(view.width) + size_t(left); };
      std::memset(tile_pixels.key, 0, sizeof tile_pixels.key);
      for (int y = 0; y < rows; y++)
        std::memcpy(tile_pixels.object + y * tile_stride, &object[at(y)],
                    size_t(columns) * sizeof(uint32_t));
      for (const SplatScratch::Chunk& chunk : scratch.chunks)
        for (uint32_t i = chunk.tile_begin[size_t(tile)]; i < chunk.tile_begin[size_t(tile) + 1];
             i++)
          draw_splat(scratch.splats[chunk.entries[i]], chunk.entries[i], left, top, tile_pixels);
      for (int y = 0; y < rows; y++)
        shown += write_row(tile_pixels.key + y * tile_stride, tile_pixels.splat + y * tile_stride,
                           scratch.splats.data(), columns, &words[at(y)], &level[at(y)]);
    }
    pixels += shown;
  });
  stats.splats = splats;
  stats.pixels = pixels;
  return stats;
}

}  // namespace wellspring::test
