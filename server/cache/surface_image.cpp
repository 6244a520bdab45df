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
    if (x0 + ahead + lanes <= width)
      for (int i = 0; i < lanes; i++) {
        uint32_t next = row[x0 + ahead + i], early = next & (0u - uint32_t(next != no_point));
        __builtin_prefetch(&colors[early]);
        __builtin_prefetch(&normals[early]);
        __builtin_prefetch(&counts[early]);
        __builtin_prefetch(&noises[early]);
      }
    for (int i = 0; i < count; i++) {
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

// The object of most weight among the neighbours of eight pixels at x (exact where one object has
// more than half). Mostly all show the same, and no vote is needed.
u8 elect_object(const Neighbour* around, int x, const i8& asked) {
  u8 least = u8{} + no_object, most{};  // no_object itself wraps around to 0 in `most`
  for (int k = 0; k < 8; k++) {
    u8 other = load<u8>(around[k].object + x), next = other + 1u;
    least = least < other ? least : other;
    most = most > next ? most : next;
  }
  if (!any(asked & (least + 1u != most))) return least;
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
  return elected;
}

// Sums over the neighbours of one kind (beside or diagonal) that show the elected object.
struct Sums {
  u8 red_blue{}, green{}, count{};
  f8 depth{};
};
i8 add(const Neighbour& from, int x, const u8& elected, Sums& sums) {
  u8 color = load<u8>(from.albedo + x);
  i8 mask = load<u8>(from.object + x) == elected;
  u8 same = as<u8>(mask);
  sums.red_blue += ((color & 2047u) | ((color >> 6) & (1023u << 16))) & same;
  sums.green += (color >> 11) & 2047u & same;
  sums.count -= same;
  sums.depth += keep(mask, as<f8>(load<u8>(from.depth + x)));
  return mask;
}
struct Nearest {
  u8 rest{}, smooth{}, more{};
};
void take(const Neighbour& from, int x, const i8& mask, Nearest& nearest) {
  nearest.rest = mask ? load<u8>(from.rest + x) : nearest.rest;
  nearest.smooth = mask ? load<u8>(from.smooth + x) : nearest.smooth;
  nearest.more = mask ? load<u8>(from.more + x) : nearest.more;
}

// Eight pixels at x, of which those `asked` for matter: averages the neighbours of the elected
// object.
void fill(const Neighbour* around, int x, const i8& asked, u8* words) {
  u8 elected = elect_object(around, x, asked);
  Sums beside, diagonal;
  Nearest nearest;
  i8 masks[8];
  for (int k = 0; k < 4; k++) masks[k] = add(around[k], x, elected, beside);
  for (int k = 4; k < 8; k++) masks[k] = add(around[k], x, elected, diagonal);
  // The nearest last, so that it stays.
  if (any(asked & (beside.count == 0u)))
    for (int k = 7; k >= 4; k--) take(around[k], x, masks[k], nearest);
  for (int k = 3; k >= 0; k--) take(around[k], x, masks[k], nearest);
  u8 weight = 2 * beside.count + diagonal.count, red_blue = 2 * beside.red_blue + diagonal.red_blue,
     green = 2 * beside.green + diagonal.green;
  i8 filled = elected != no_object;
  f8 share = 1.0f / larger(to_float(weight), splat(1));
  auto mean = [&](const u8& sum) {
    return as<u8>(__builtin_convertvector(to_float(sum) * share + 0.5f, i8));
  };
  u8 known = as<u8>(filled);
  words[plane_albedo] =
      (mean(red_blue & 0xffffu) | mean(green) << 11 | mean(red_blue >> 16) << 22) & known;
  words[plane_rest] = nearest.rest & known;
  words[plane_smooth] = nearest.smooth & known;
  words[plane_object] = elected;
  words[plane_more] = nearest.more & known & 0xffffu;  // of the samples, none are its own
  words[plane_depth] = as<u8>((2.0f * beside.depth + diagonal.depth) * share) & known;
}

}  // namespace

int fill_from_neighbours(const SurfaceRows& rows, int y, Frame& frame) {
  Neighbour around[8];
  for (int k = 0; k < 8; k++) {
    auto row = [&](SurfacePlane plane) { return rows.row(plane, y + around_y[k]) + around_x[k]; };
    around[k] = {row(plane_albedo), row(plane_rest), row(plane_smooth),
                 row(plane_object), row(plane_more), row(plane_depth)};
  }
  PackedRow packed(frame, y);
  u8 points{};
  for (int x = 0; x < frame.width; x += lanes) {
    u8 words[surface_planes];
    for (int p = 0; p < surface_planes; p++) words[p] = load<u8>(rows.row(SurfacePlane(p), y) + x);
    i8 hole = words[plane_object] == no_object;  // beyond the end all are
    points += as<u8>(hole) + 1u;
    if (any(hole)) {
      u8 filled[surface_planes];
      fill(around, x, hole, filled);
      for (int p = 0; p < surface_planes; p++) words[p] = hole ? filled[p] : words[p];
    }
    size_t at = sizeof(uint32_t) * size_t(x);
    if (x + lanes <= frame.width)
      for (int p = 0; p < surface_planes; p++) store(packed.plane[p] + at, words[p]);
    else
      for (int p = 0; p < surface_planes; p++)
        std::memcpy(packed.plane[p] + at, &words[p], sizeof(uint32_t) * size_t(frame.width - x));
  }
  int sum = 0;
  for (int i = 0; i < lanes; i++) sum += int(points[i]);
  return sum;
}

}  // namespace wellspring
