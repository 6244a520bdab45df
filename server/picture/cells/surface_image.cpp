// SPDX-License-Identifier: Apache-2.0
#include "picture/cells/surface_image.h"

#include <algorithm>

#include "base/simd.h"
#include "cache/packing.h"
#include "cache/reconstruct.h"

namespace wellspring::picture {
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
  const uint8_t* counts = points.count.data();
  uint32_t* albedo = rows.row(plane_albedo, y);
  uint32_t* rest = rows.row(plane_rest, y);
  uint32_t* smooth = rows.row(plane_smooth, y);
  uint32_t* object = rows.row(plane_object, y);
  uint32_t* more_row = rows.row(plane_more, y);
  LaneBits converged{};
  for (int x = 0; x < width; x += lane_count) {
    // There is no branch: without a point, point 0 is read and thrown away.
    alignas(32) uint32_t point[lane_count];
    if (x + ahead + lane_count <= width) {
      LaneBits early = load_lanes<LaneBits>(row + x + ahead);
      store_lanes(point, early & lanes_as<LaneBits>(early != no_point));
      for (uint32_t next : point) {
        auto record = reinterpret_cast<const char*>(&colors[next]);
        __builtin_prefetch(record);
        __builtin_prefetch(record + sizeof(PointColor) - 1);  // records do not stop at cache lines
      }
    }
    LaneBits index = LaneBits{} + no_point;
    if (x + lane_count <= width) index = load_lanes<LaneBits>(row + x);
    else std::memcpy(&index, row + x, size_t(width - x) * sizeof(uint32_t));
    LaneBits known = lanes_as<LaneBits>(index != no_point);
    store_lanes(point, index & known);
    LaneBits a, s, r, o;
    transpose_records([&](int i) { return &colors[point[i]]; }, a, s, r,
                      o);  // in the order of PointColor
    auto more = [&](int i) {
      uint32_t word;
      std::memcpy(&word, &colors[point[i]].normal, sizeof word);
      // The count takes the place of the doubts.
      return (word & 0xff00ffffu) | uint32_t(counts[point[i]]) << 16;
    };
    LaneBits m{more(0), more(1), more(2), more(3), more(4), more(5), more(6), more(7)};
    m &= known;
    store_lanes(albedo + x, a & known);
    store_lanes(smooth + x, s & known);
    store_lanes(rest + x, r & known);
    store_lanes(object + x, o | ~known);
    store_lanes(more_row + x, m);
    converged -= lanes_as<LaneBits>(((m >> 16) & 255u) >= converged_samples);
  }
  std::memcpy(rows.row(plane_depth, y), depth, size_t(width) * sizeof(float));
  int sum = 0;
  for (int i = 0; i < lane_count; i++) sum += int(converged[i]);
  return sum;
}

namespace {

constexpr int around_x[8] = {-1, 1, 0, 0, -1, 1, -1, 1}, around_y[8] = {0, 0, -1, 1, -1, -1, 1, 1};

struct Neighbour {
  const uint32_t *albedo, *rest, *smooth, *object, *more, *depth;
};

// Returns the object of most weight among the neighbours of eight pixels at x (exact if one object
// has more than half). Mostly all show the same, and no vote is needed.
LaneBits elect_object(const Neighbour* around, int x, const LaneMask& asked) {
  LaneBits least = LaneBits{} + no_object, most{};  // no_object itself wraps around to 0 in `most`
  for (int k = 0; k < 8; k++) {
    LaneBits other = load_lanes<LaneBits>(around[k].object + x), next = other + 1u;
    least = least < other ? least : other;
    most = most > next ? most : next;
  }
  if (!any_lane(asked & (least + 1u != most))) return least;
  LaneBits elected = LaneBits{} + no_object;
  LaneMask votes{};
  for (int k = 0; k < 8; k++) {
    int32_t weight = k < 4 ? 2 : 1;
    LaneBits other = load_lanes<LaneBits>(around[k].object + x);
    LaneMask there = other != no_object, same = other == elected;
    votes += there & ((same & (2 * weight)) - weight);
    LaneMask lost = votes < 0;
    elected = lost ? other : elected;
    votes = (votes ^ lost) - lost;
  }
  return elected;
}

// Holds sums over the neighbours of one kind (beside or diagonal) that show the elected object.
struct Sums {
  LaneBits red_blue{}, green{}, count{};
  Lanes depth{};
};
LaneMask add(const Neighbour& from, int x, const LaneBits& elected, Sums& sums) {
  LaneMask mask = load_lanes<LaneBits>(from.object + x) == elected;
  LaneBits same = lanes_as<LaneBits>(mask), color = load_lanes<LaneBits>(from.albedo + x) & same;
  sums.red_blue += (color & 2047u) | ((color >> 6) & (1023u << 16));
  sums.green += (color >> 11) & 2047u;
  sums.count -= same;
  sums.depth += lanes_as<Lanes>(load_lanes<LaneBits>(from.depth + x) & same);
  return mask;
}
struct Nearest {
  LaneBits rest{}, smooth{}, more{};
};
void take(const Neighbour& from, int x, const LaneMask& mask, Nearest& nearest) {
  nearest.rest = mask ? load_lanes<LaneBits>(from.rest + x) : nearest.rest;
  nearest.smooth = mask ? load_lanes<LaneBits>(from.smooth + x) : nearest.smooth;
  nearest.more = mask ? load_lanes<LaneBits>(from.more + x) : nearest.more;
}

// Fills eight pixels at x, of which those `asked` for matter, with the mean of their neighbours of
// the elected object.
void fill(const Neighbour* around, int x, const LaneMask& asked, LaneBits* words) {
  LaneBits elected = elect_object(around, x, asked);
  Sums beside, diagonal;
  Nearest nearest;
  LaneMask masks[8];
  for (int k = 0; k < 4; k++) masks[k] = add(around[k], x, elected, beside);
  for (int k = 4; k < 8; k++) masks[k] = add(around[k], x, elected, diagonal);
  // The nearest comes last, so that it stays.
  if (any_lane(asked & (beside.count == 0u)))
    for (int k = 7; k >= 4; k--) take(around[k], x, masks[k], nearest);
  for (int k = 3; k >= 0; k--) take(around[k], x, masks[k], nearest);
  LaneBits weight = 2 * beside.count + diagonal.count,
           red_blue = 2 * beside.red_blue + diagonal.red_blue,
           green = 2 * beside.green + diagonal.green;
  LaneMask filled = elected != no_object;
  Lanes share = 1.0f / lanes_max(to_float(weight), all_lanes(1));
  auto mean = [&](const LaneBits& sum) {
    return lanes_as<LaneBits>(__builtin_convertvector(to_float(sum) * share + 0.5f, LaneMask));
  };
  LaneBits known = lanes_as<LaneBits>(filled);
  words[plane_albedo] =
      (mean(red_blue & 0xffffu) | mean(green) << 11 | mean(red_blue >> 16) << 22) & known;
  words[plane_rest] = nearest.rest & known;
  words[plane_smooth] = nearest.smooth & known;
  words[plane_object] = elected;
  words[plane_more] = nearest.more & known & 0xffffu;  // it has no samples of its own
  words[plane_depth] = lanes_as<LaneBits>((2.0f * beside.depth + diagonal.depth) * share) & known;
}

// Writes eight pixels at x to the frame.
void pack(const LaneBits* words, int x, int y, Frame& frame) {
  size_t row = size_t(y) * size_t(frame.width);
  if (x >= 0 && x + lane_count <= frame.width) {
    size_t at = row + size_t(x);
    store_lanes(&frame.object[at], words[plane_object]);
    store_lanes(&frame.confidence[at], words[plane_more]);
    store_lanes(&frame.depth[at], words[plane_depth]);
    uint32_t* to = packed_words(frame, x, y);
    for (int p : {plane_albedo, plane_rest, plane_smooth}) {
      store_lanes(to + packed_four * p, low_half(words[p]));
      store_lanes(to + packed_four * (p + 3), high_half(words[p]));
    }
    return;
  }
  for (int half = 0; half < lane_count; half += packed_four) {
    PackedFour four(x + half, frame.width);
    if (four.count <= 0) continue;
    auto put = [&](int plane, auto* to) {
      uint32_t word[lane_count];
      store_lanes(word, words[plane]);
      std::memcpy(to, word + (four.first - x), sizeof(uint32_t) * size_t(four.count));
    };
    size_t at = row + size_t(four.first);
    put(plane_object, &frame.object[at]);
    put(plane_more, &frame.confidence[at]);
    put(plane_depth, &frame.depth[at]);
    uint32_t* to = packed_words(frame, four.first, y);
    for (int p : {plane_albedo, plane_rest, plane_smooth}) put(p, to + four.count * p);
  }
}

}  // namespace

int fill_from_neighbours(const SurfaceRows& rows, int y, Frame& frame) {
  Neighbour around[8];
  for (int k = 0; k < 8; k++) {
    auto row = [&](SurfacePlane plane) { return rows.row(plane, y + around_y[k]) + around_x[k]; };
    around[k] = {row(plane_albedo), row(plane_rest), row(plane_smooth),
                 row(plane_object), row(plane_more), row(plane_depth)};
  }
  const uint32_t* own[surface_planes];
  for (int p = 0; p < surface_planes; p++) own[p] = rows.row(SurfacePlane(p), y);
  LaneBits points{};
  for (int x = packed_start; x < frame.width; x += lane_count) {
    LaneBits words[surface_planes];
    for (int p = 0; p < surface_planes; p++) words[p] = load_lanes<LaneBits>(own[p] + x);
    LaneMask hole = words[plane_object] == no_object;  // all pixels beyond the ends are holes
    points += lanes_as<LaneBits>(hole) + 1u;
    if (any_lane(hole)) {
      LaneBits filled[surface_planes];
      fill(around, x, hole, filled);
      for (int p = 0; p < surface_planes; p++) words[p] = hole ? filled[p] : words[p];
    }
    pack(words, x, y, frame);
  }
  int sum = 0;
  for (int i = 0; i < lane_count; i++) sum += int(points[i]);
  return sum;
}

}  // namespace wellspring::picture
