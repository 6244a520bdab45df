// SPDX-License-Identifier: Apache-2.0
#include "cache/surface_image.h"

#include <algorithm>

#include "cache/lanes.h"

namespace wellspring {

int read_points(const PointCache& points, const PointImage& image, int y, SurfaceRows& rows) {
  constexpr int ahead = 32;  // pixels by which point data is fetched early
  if (y < 0 || y >= image.height || points.capacity() == 0) {
    rows.clear(y);
    return 0;
  }
  int width = image.width;
  const uint32_t* row = image.point.data() + size_t(y) * size_t(width);
  const float* depth = image.depth.data() + size_t(y) * size_t(width);
  const PointColor* colors = points.color.data();
  const uint16_t* normals = points.normal.data();
  const uint8_t* counts = points.count.data();
  const uint8_t* noises = points.noise.data();
  uint32_t* albedo = rows.row(plane_albedo, y);
  uint32_t* rest = rows.row(plane_rest, y);
  uint32_t* smooth = rows.row(plane_smooth, y);
  uint32_t* object = rows.row(plane_object, y);
  uint32_t* more = rows.row(plane_more, y);
  u8 converged{};
  for (int x0 = 0; x0 < width; x0 += lanes) {
    int count = std::min(lanes, width - x0);
    alignas(32) uint32_t records[4 * lanes] = {}, others[lanes] = {}, there[lanes] = {};
    // No branch: where there is no point, the first one is read and thrown away.
    for (int i = 0; i < count; i++) {
      int next = std::min(x0 + i + ahead, width - 1);
      uint32_t early = row[next] & (0u - uint32_t(row[next] != no_point));
      __builtin_prefetch(&colors[early]);
      there[i] = 0u - uint32_t(row[x0 + i] != no_point);
      uint32_t point = row[x0 + i] & there[i];
      std::memcpy(records + 4 * i, &colors[point], 16);
      others[i] = normals[point] | uint32_t(counts[point]) << 16 | uint32_t(noises[point]) << 24;
    }
    u8 a, s, r, o, known = load<u8>(there), m = load<u8>(others) & known;
    transpose(records, a, s, r, o);  // in the order of PointColor
    store(albedo + x0, a & known);
    store(smooth + x0, s & known);
    store(rest + x0, r & known);
    store(object + x0, (o & known) | ~known);
    store(more + x0, m);
    converged -= as<u8>(((m >> 16) & 255u) >= converged_samples);
  }
  std::memcpy(rows.row(plane_depth, y), depth, size_t(width) * sizeof(float));
  int sum = 0;
  for (int i = 0; i < lanes; i++) sum += int(converged[i]);
  return sum;
}

namespace {

constexpr int around_x[8] = {-1, 1, 0, 0, -1, 1, -1, 1}, around_y[8] = {0, 0, -1, 1, -1, -1, 1, 1};

struct Neighbour {
  const uint32_t *albedo, *rest, *smooth, *object, *more, *depth;
};

// Sums over the neighbours of one kind (beside or diagonal) that show the elected object.
struct Sums {
  u8 red_blue{}, green{}, count{};
  f8 depth{};
};

// Eight pixels at x: a weighted majority vote elects the object (exact where one object has more
// than half), then its neighbours are averaged.
void fill(const Neighbour* around, int x, u8& albedo, u8& rest, u8& smooth, u8& object, u8& more,
          f8& depth) {
  u8 elected = u8{} + no_object;
  i8 votes{};
  for (int k = 0; k < 8; k++) {
    int32_t weight = k < 4 ? 2 : 1;
    u8 other = load<u8>(around[k].object + x);
    i8 there = other != no_object, same = other == elected;
    votes += there & ((same & (2 * weight)) - weight);
    i8 lost = votes < 0;
    elected = lost ? other : elected;
    votes = (votes ^ lost) - lost;
  }
  Sums beside, diagonal;
  u8 near_rest{}, near_smooth{}, near_more{};
  // The nearest last, so that it stays.
  for (int k = 7; k >= 0; k--) {
    Sums& sums = k < 4 ? beside : diagonal;
    u8 other = load<u8>(around[k].object + x), color = load<u8>(around[k].albedo + x);
    i8 mask = (other == elected) & (other != no_object);
    u8 same = as<u8>(mask);
    sums.red_blue += ((color & 2047u) | ((color >> 6) & (1023u << 16))) & same;
    sums.green += (color >> 11) & 2047u & same;
    sums.count -= same;
    sums.depth += keep(mask, as<f8>(load<u8>(around[k].depth + x)));
    near_rest = mask ? load<u8>(around[k].rest + x) : near_rest;
    near_smooth = mask ? load<u8>(around[k].smooth + x) : near_smooth;
    near_more = mask ? load<u8>(around[k].more + x) : near_more;
  }
  u8 weight = 2 * beside.count + diagonal.count, red_blue = 2 * beside.red_blue + diagonal.red_blue,
     green = 2 * beside.green + diagonal.green;
  i8 filled = weight != 0u;
  f8 share = 1.0f / larger(to_float(weight), splat(1));
  auto mean = [&](const u8& sum) {
    return as<u8>(__builtin_convertvector(to_float(sum) * share + 0.5f, i8));
  };
  u8 keep_bits = as<u8>(filled);
  albedo = mean(red_blue & 0xffffu) | mean(green) << 11 | mean(red_blue >> 16) << 22;
  albedo &= keep_bits;
  rest = near_rest;
  smooth = near_smooth;
  more = near_more & 0xffffu;  // of the samples, none are its own
  depth = (2.0f * beside.depth + diagonal.depth) * share;
  object = (elected & keep_bits) | ~keep_bits;
}

}  // namespace

int fill_from_neighbours(const SurfaceRows& rows, int width, int y, SurfaceRows& filled) {
  Neighbour around[8];
  for (int k = 0; k < 8; k++) {
    auto row = [&](SurfacePlane plane) { return rows.row(plane, y + around_y[k]) + around_x[k]; };
    around[k] = {row(plane_albedo), row(plane_rest), row(plane_smooth),
                 row(plane_object), row(plane_more), row(plane_depth)};
  }
  const uint32_t* own[surface_planes];
  uint32_t* out[surface_planes];
  for (int p = 0; p < surface_planes; p++) {
    own[p] = rows.row(SurfacePlane(p), y);
    out[p] = filled.row(SurfacePlane(p), y);
  }
  u8 points{};
  for (int x = 0; x < width; x += lanes) {
    u8 object = load<u8>(own[plane_object] + x), albedo = load<u8>(own[plane_albedo] + x),
       rest = load<u8>(own[plane_rest] + x), smooth = load<u8>(own[plane_smooth] + x),
       more = load<u8>(own[plane_more] + x), depth = load<u8>(own[plane_depth] + x);
    i8 hole = object == no_object;
    points += as<u8>(hole) + 1u;
    if (any(hole)) {
      u8 a, r, s, o, m;
      f8 d;
      fill(around, x, a, r, s, o, m, d);
      albedo = hole ? a : albedo;
      rest = hole ? r : rest;
      smooth = hole ? s : smooth;
      object = hole ? o : object;
      more = hole ? m : more;
      depth = hole ? as<u8>(d) : depth;
    }
    store(out[plane_albedo] + x, albedo);
    store(out[plane_rest] + x, rest);
    store(out[plane_smooth] + x, smooth);
    store(out[plane_object] + x, object);
    store(out[plane_more] + x, more);
    store(out[plane_depth] + x, depth);
  }
  int sum = 0;  // lanes beyond the end are padding and count as holes
  for (int i = 0; i < lanes; i++) sum += int(points[i]);
  return sum;
}

}  // namespace wellspring
