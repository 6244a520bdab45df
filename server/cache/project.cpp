// SPDX-License-Identifier: Apache-2.0
#include "cache/project.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <vector>

#include "base/parallel.h"
#include "base/simd.h"

namespace wellspring::cache {
namespace {

constexpr int tile_bits = 6, tile_size = 1 << tile_bits, tile_pixels = tile_size * tile_size;
constexpr int chunk_points = 16384;   // points transformed and sorted together; offsets fit 16 bits
constexpr float near_depth = 1e-4f;   // metres
constexpr float facing_away = 0.15f;  // cosine by which a (shading) normal may point away

// An entry of a bin has 28 bits of depth, 24 of the point, 12 of the pixel in its tile.
constexpr int point_shift = 12, depth_shift = 36, depth_cut = 3;
constexpr uint64_t point_mask = (1u << 24) - 1;

struct Tiles {
  int x, y;
  int count() const { return x * y; }
};
Tiles tiles_of(int width, int height) {
  return {(width + tile_size - 1) >> tile_bits, (height + tile_size - 1) >> tile_bits};
}
int chunks_of(int capacity) { return (capacity + chunk_points - 1) / chunk_points; }

// Holds everything a point needs to find its pixel.
struct Transform {
  vec3 eye, right, up, forward;
  float focal, axis_x, axis_y, width, height, near;
  int tiles_x, no_tile;
};

// Holds where the points of one chunk fall: the tile (no_tile: nowhere), the pixel in it, the
// depth.
struct ChunkPlaces {
  alignas(64) int32_t tile[chunk_points];
  alignas(64) int32_t local[chunk_points];
  alignas(64) uint32_t depth[chunk_points];
};

// Transforms points branch-free, so that it vectorises; every comparison with NaN is false and
// leads to no_tile.
void transform_chunk(const Transform& t, const PointCache& points, int begin, int count,
                     ChunkPlaces& places) {
  const float* px = points.x.data() + begin;
  const float* py = points.y.data() + begin;
  const float* pz = points.z.data() + begin;
  const uint16_t* normal = points.normal.data() + begin;
  const uint8_t* flags = points.flags.data() + begin;
  const uint8_t* age = points.age.data() + begin;
  int32_t* __restrict tile = places.tile;
  int32_t* __restrict local = places.local;
  uint32_t* __restrict depth_bits = places.depth;
  for (int i = 0; i < count; i++) {
    int32_t flag = flags[i];
    int32_t infinite = (flag >> 1) & 1;
    float here = float(1 - infinite);
    float dx = px[i] - t.eye.x * here, dy = py[i] - t.eye.y * here, dz = pz[i] - t.eye.z * here;
    float depth = dx * t.forward.x + dy * t.forward.y + dz * t.forward.z;
    float across = dx * t.right.x + dy * t.right.y + dz * t.right.z;
    float above = dx * t.up.x + dy * t.up.y + dz * t.up.z;
    float scale = t.focal / depth;
    float sx = across * scale + t.axis_x, sy = t.axis_y - above * scale;

    int32_t packed = normal[i];
    float ox = float(packed & 255) * (1.0f / 127) - 1, oy = float(packed >> 8) * (1.0f / 127) - 1;
    float oz = 1 - std::abs(ox) - std::abs(oy);
    float fold = oz < 0 ? -oz : 0.0f;
    ox += ox >= 0 ? -fold : fold;
    oy += oy >= 0 ? -fold : fold;
    float away = ox * dx + oy * dy + oz * dz;

    int32_t good = int32_t(depth > t.near) & int32_t(sx >= 0.0f) & int32_t(sx < t.width) &
                   int32_t(sy >= 0.0f) & int32_t(sy < t.height) &
                   int32_t(away <= facing_away * depth) & int32_t(age[i] != evicted_age) & flag;
    float cx = sx > 0.0f ? sx : 0.0f, cy = sy > 0.0f ? sy : 0.0f;
    cx = cx < t.width ? cx : 0.0f;
    cy = cy < t.height ? cy : 0.0f;
    int32_t ix = int32_t(cx), iy = int32_t(cy);
    int32_t where = (iy >> tile_bits) * t.tiles_x + (ix >> tile_bits);
    tile[i] = good ? where : t.no_tile;
    local[i] = (iy & (tile_size - 1)) << tile_bits | (ix & (tile_size - 1));
    float stored = infinite ? infinite_depth : depth;
    depth_bits[i] = std::bit_cast<uint32_t>(stored) >> depth_cut;
  }
}

void count_tiles(const int32_t* __restrict tile, int count, uint32_t* __restrict next) {
  for (int i = 0; i < count; i++) next[size_t(tile[i]) + 1]++;
}

// Sorts a chunk's points that fall somewhere by their tile; `next`: index of each tile's first
// entry.
void sort_by_tile(const ChunkPlaces& places, int begin, int count, uint32_t* __restrict next,
                  uint64_t* __restrict entries) {
  for (int i = 0; i < count; i++) {
    uint32_t place = next[size_t(places.tile[i])]++;
    entries[place] = uint64_t(places.depth[i]) << depth_shift | uint64_t(begin + i) << point_shift |
                     uint64_t(places.local[i]);
  }
}

void keep_nearest(const uint64_t* __restrict entries, uint32_t count,
                  uint64_t* __restrict nearest) {
  for (uint32_t i = 0; i < count; i++) {
    uint64_t entry = entries[i], key = entry >> point_shift;
    uint64_t& slot = nearest[entry & (tile_pixels - 1)];
    slot = key < slot ? key : slot;
  }
}

// Writes a row of a tile into the image; slots without a point have all bits set.
void write_row(const uint64_t* __restrict nearest, int columns, uint32_t* __restrict point,
               float* __restrict depth) {
  for (int x = 0; x < columns; x++) {
    uint32_t empty = 0u - uint32_t(nearest[x] == ~uint64_t(0));
    uint32_t bits = uint32_t(nearest[x] >> (depth_shift - point_shift)) << depth_cut;
    point[x] = uint32_t(nearest[x] & point_mask) | empty;
    depth[x] = std::bit_cast<float>(bits & ~empty);
  }
}
// Every second pixel may be empty: the points of the others are listed first, since a branch that
// nobody can predict costs more than all the rest.
void show_row(const uint32_t* __restrict point, int columns, uint8_t* __restrict flags) {
  uint32_t shown[tile_size + 1];
  size_t count = 0;
  for (int x = 0; x < columns; x++) {
    shown[count] = point[x];
    count += point[x] != no_point;
  }
  for (size_t i = 0; i < count; i++) flags[shown[i]] |= point_visible;
}

}  // namespace

size_t project_scratch_bytes(int capacity, int width, int height) {
  size_t offsets = size_t(chunks_of(capacity)) * size_t(tiles_of(width, height).count() + 1);
  return Scratch::rounded<uint64_t>(size_t(capacity)) + Scratch::rounded<uint16_t>(offsets);
}

void project_points(PointCache& points, const WindowView& view, bool same_view, Scratch& scratch,
                    PointImage& image) {
  int capacity = points.capacity();
  Tiles tiles = tiles_of(view.width, view.height);
  int chunks = chunks_of(capacity), tile_count = tiles.count();
  scratch.start(project_scratch_bytes(capacity, view.width, view.height));
  std::span<uint64_t> entries = scratch.take<uint64_t>(size_t(capacity));
  std::span<uint16_t> offsets = scratch.take<uint16_t>(size_t(chunks) * size_t(tile_count + 1));

  const vec2 axis = axis_place(view) - view.shift;
  Transform transform{view.position,
                      view.right,
                      view.up,
                      view.forward,
                      float(view.height) * 0.5f / view.tan_half_fov,
                      axis.x,
                      axis.y,
                      float(view.width),
                      float(view.height),
                      std::max(view.near, near_depth),
                      tiles.x,
                      tile_count};
  uint8_t keep = uint8_t(~(point_visible | (same_view ? 0 : point_verified)));

  // Pass 1 transforms, then sorts each chunk's points by tile into the chunk's part of `entries`.
  parallel_for(chunks, [&](int chunk) {
    thread_local ChunkPlaces places;
    thread_local std::vector<uint32_t> next;
    int begin = chunk * chunk_points, count = std::min(chunk_points, capacity - begin);
    transform_chunk(transform, points, begin, count, places);
    uint8_t* flags = points.flags.data() + begin;
    for (int i = 0; i < count; i++) flags[i] &= keep;
    next.assign(size_t(tile_count) + 2, 0);
    count_tiles(places.tile, count, next.data());
    uint16_t* offset = offsets.data() + size_t(chunk) * size_t(tile_count + 1);
    uint32_t sum = 0;
    for (int t = 0; t <= tile_count; t++) {
      sum += next[size_t(t)];
      next[size_t(t)] = sum;
      offset[t] = uint16_t(sum);
    }
    sort_by_tile(places, begin, count, next.data(), entries.data() + begin);
  });

  // Pass 2 does the z-buffer tile by tile.
  parallel_for(tile_count, [&](int tile) {
    alignas(64) uint64_t nearest[tile_pixels];
    std::memset(nearest, 0xff, sizeof nearest);
    auto run_of = [&](int chunk) {
      const uint16_t* offset = offsets.data() + size_t(chunk) * size_t(tile_count + 1) + tile;
      return entries.subspan(size_t(chunk) * chunk_points + offset[0],
                             size_t(offset[1] - offset[0]));
    };
    // The runs lie far apart: while one is looked at, the next ones are fetched.
    constexpr int ahead = 2, line = 64 / sizeof(uint64_t);
    for (int chunk = 0; chunk < chunks; chunk++) {
      if (chunk + ahead < chunks) {
        std::span<const uint64_t> next = run_of(chunk + ahead);
        for (size_t i = 0; i < next.size(); i += line) __builtin_prefetch(&next[i]);
      }
      std::span<const uint64_t> run = run_of(chunk);
      keep_nearest(run.data(), uint32_t(run.size()), nearest);
    }
    int x0 = (tile % tiles.x) << tile_bits, y0 = (tile / tiles.x) << tile_bits;
    int columns = std::min(tile_size, view.width - x0),
        rows = std::min(tile_size, view.height - y0);
    for (int y = 0; y < rows; y++) {
      size_t at = size_t(y0 + y) * size_t(view.width) + size_t(x0);
      write_row(nearest + (y << tile_bits), columns, &image.point[at], &image.depth[at]);
      show_row(&image.point[at], columns, points.flags.data());
    }
  });
}

// Depths are compared as 16-bit codes, sixteen pixels at a time.

namespace {

constexpr int reach = 2;  // rows and columns looked at on every side
constexpr int window = 2 * reach + 1;
constexpr int run = 16;  // pixels judged together
using ShortLanes = int16_t __attribute__((vector_size(2 * run)));

// 1024 steps an octave from 2^-14 m to 2^50 m: fine enough for a threshold of some percent.
constexpr int32_t least_depth = (127 - 14) << 23;
constexpr int16_t nothing = 32767;  // code of an empty pixel: nearer than none
constexpr int16_t nearest = -32768;

int16_t code_of(float depth) {
  int32_t code = (std::bit_cast<int32_t>(depth) - least_depth) >> 13;
  code = code > 0 ? code : 0;
  return int16_t((code < 65534 ? code : 65534) - 32768);
}

// Holds the last rows of the picture as codes, each padded by `reach` and a run of empty pixels.
struct Codes {
  size_t stride = 0;
  std::vector<int16_t> rows, limit;  // limit: codes below it hide the pixel
  int16_t* row(int y) { return rows.data() + size_t(y + reach) % window * stride + reach; }
  void start(int width) {
    stride = size_t(width) + 2 * reach + run;
    rows.assign(stride * window, nothing);
    limit.assign(stride, nearest);
  }
  void read(const PointImage& image, int y) {
    int16_t* codes = row(y);
    if (y < 0 || y >= image.height) {
      std::fill_n(codes, image.width, nothing);
      return;
    }
    const float* depth = image.depth.data() + size_t(y) * size_t(image.width);
    for (int x = 0; x < image.width; x++) codes[x] = depth[x] > 0.0f ? code_of(depth[x]) : nothing;
  }
  void read_limit(const PointImage& image, int y, float share) {
    const float* depth = image.depth.data() + size_t(y) * size_t(image.width);
    for (int x = 0; x < image.width; x++) limit[size_t(x)] = code_of(depth[x] * share);
  }
};

// Returns all bits set for pixels whose point lies behind what surrounds it. `rows` point at the
// first pixel.
ShortLanes judge(const int16_t* const* rows, const int16_t* limits) {
  ShortLanes limit = load_lanes<ShortLanes>(limits), columns[window] = {}, lines[window] = {};
#pragma GCC unroll 5
  for (int dy = 0; dy < window; dy++)
#pragma GCC unroll 5
    for (int dx = 0; dx < window; dx++) {
      ShortLanes nearer = load_lanes<ShortLanes>(rows[dy] + dx - reach) < limit;
      columns[dx] += nearer;
      lines[dy] += nearer;
    }
  ShortLanes nearer = -(columns[0] + columns[1] + columns[2] + columns[3] + columns[4]);
  ShortLanes several = nearer >= 3;
  if (!any_lane(several)) return several;
  ShortLanes sx = 2 * (columns[4] - columns[0]) + columns[3] - columns[1],
             sy = 2 * (lines[4] - lines[0]) + lines[3] - lines[1], others = ShortLanes{} - 1;
  for (int dy = 0; dy < window; dy++)
    for (int dx = 0; dx < window; dx++)
      others -= load_lanes<ShortLanes>(rows[dy] + dx - reach) != nothing;
  // Nearer neighbours on all sides have a short mean offset; those of a silhouette have a long one.
  // They hide only as the majority: through a lattice the background shows rightly.
  ShortLanes around =
      (nearer >= 4) & (2 * nearer >= others) & (sx * sx + sy * sy <= nearer * nearer);
  ShortLanes alone = several & (4 * nearer >= 3 * others);
  return around | alone;
}

}  // namespace

void depth_cull(PointCache& points, float threshold, PointImage& image) {
  int width = image.width, height = image.height;
  float share = 1 / (1 + std::max(threshold, 0.0f));
  // The verdict is kept apart until all rows have been judged; priority is free until attend().
  uint8_t* verdicts = image.priority.data();
  parallel_ranges(height, 16, [&](int begin, int end) {
    thread_local Codes codes;
    codes.start(width);
    for (int y = begin - reach; y < begin + reach; y++) codes.read(image, y);
    for (int y = begin; y < end; y++) {
      codes.read(image, y + reach);
      codes.read_limit(image, y, share);
      uint8_t* verdict = verdicts + size_t(y) * size_t(width);
      for (int x = 0; x < width; x += run) {
        const int16_t* rows[window];
        for (int dy = 0; dy < window; dy++) rows[dy] = codes.row(y + dy - reach) + x;
        ShortLanes hidden = judge(rows, codes.limit.data() + x);
        for (int i = 0; i < std::min(run, width - x); i++) verdict[x + i] = uint8_t(hidden[i]);
      }
    }
  });
  parallel_ranges(height, 16, [&](int begin, int end) {
    size_t last = size_t(end) * size_t(width);
    for (size_t i = size_t(begin) * size_t(width); i < last; i++) {
      uint64_t eight;
      if (i + 8 <= last && (std::memcpy(&eight, verdicts + i, 8), eight == 0)) {
        i += 7;
        continue;
      }
      if (!verdicts[i] || image.point[i] == no_point) continue;
      uint8_t& flags = points.flags[image.point[i]];
      if (flags & point_verified) continue;
      flags &= uint8_t(~point_visible);
      image.point[i] = no_point;
      image.depth[i] = 0;
    }
  });
}

}  // namespace wellspring::cache
