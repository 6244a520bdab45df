// SPDX-License-Identifier: Apache-2.0
#include "scan/draw/disc_bins.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

#include "base/simd.h"
#include "scan/draw/normal_lanes.h"

namespace wellspring::scan {
namespace {

constexpr float least_radius = 0.75f;  // pixels of a disc's axes; above half a pixel's diagonal
constexpr float least_narrow = 0.71f;  // the same of the shorter axis
constexpr float single_below = 0.35f;  // discs of a smaller radius are one pixel
constexpr float steepest = 8;          // tangent of the angle up to which discs are leant
// A point whose own spacing is so many times its node's lies in a sparse place, which discs of the
// node's size do not cover; points at random on a surface are below it. Its disc grows so much at
// most, and from a still larger spacing on it lies alone, as those do that scanners put into the
// air between two surfaces.
constexpr float sparse_from = 1.8f, most_growth = 3, alone_from = 5;
constexpr float nearest_depth = 1e-6f;   // metres
constexpr float outside_places = 32000;  // pixels; Disc::x has 24 bits

// Leads from a node's places to the eye's frame: right, up, forward.
struct ToEye {
  vec3 shift, x, y, z;
  mat3 turn;  // for normals
  ToEye(const NodePoints& node, const ScanCamera& view) {
    const dvec3 from = node.corner - view.eye;
    const dvec3 right(view.right), up(view.up), forward(view.forward);
    const double step = double(node.size) / 65536;
    const dvec3 first = from + dvec3(0.5 * step);
    shift = vec3(dot(first, right), dot(first, up), dot(first, forward));
    turn = glm::transpose(mat3(view.right, view.up, view.forward));
    x = turn[0] * float(step), y = turn[1] * float(step), z = turn[2] * float(step);
  }
};

using Bytes = uint8_t __attribute__((vector_size(lane_count)));
using Words = uint16_t __attribute__((vector_size(2 * lane_count)));
inline LaneMask load_words(const uint16_t* from) {
  return __builtin_convertvector(load_lanes<Words>(from), LaneMask);
}
inline Lanes whole_lanes(const LaneMask& a) { return __builtin_convertvector(a, Lanes); }
inline Lanes clamp_lanes(const Lanes& a, float low, float high) {
  return lanes_min(lanes_max(a, all_lanes(low)), all_lanes(high));
}

// Holds eight points' discs and the boxes of pixels that they touch, cut to the picture.
struct EightDiscs {
  LaneMask x, y;
  Lanes depth, lean_x, lean_y, radius, slope;
  LaneMask low_x, high_x, low_y, high_y;
  LaneMask seen;
  LaneMask large;  // among `seen`: spheres that need more pixels
};

// Returns how far a node reaches to both sides of the plane of a cut, metres: below 0, nothing of
// it is on that side.
struct CutReach {
  double kept, lost;
  CutReach(const NodePoints& node, const ScanCut& cut) {
    const dvec3 normal(cut.normal), half(0.5 * double(node.size));
    const double middle = glm::dot(normal, node.corner + half) - double(cut.offset);
    const double reach = glm::dot(glm::abs(normal), half);
    kept = middle + reach, lost = reach - middle;
  }
};

// How a node is projected.
struct Projection {
  ToEye to_eye;
  float focal, axis_x, axis_y, near;
  float radius;  // metres
  float most_pixels;
  bool spheres;
  int width, height;
  std::vector<ScanCut> cuts;  // those that cross the node, in the eye's frame

  Projection(const NodePoints& node, const ScanCamera& view, const DiscStyle& style)
      : to_eye(node, view),
        focal(view.focal()),
        axis_x(view.axis_place().x - view.offset.x),
        axis_y(view.axis_place().y - view.offset.y),
        near(std::max(view.near, nearest_depth)),
        radius(style.radius * node.spacing),
        most_pixels(std::clamp(style.most_pixels, least_radius, 31.0f)),
        spheres(style.spheres),
        width(view.width),
        height(view.height) {
    for (const ScanCut& cut : view.cuts)
      if (CutReach(node, cut).lost > 0)
        cuts.push_back({to_eye.turn * cut.normal,
                        float(double(cut.offset) - glm::dot(dvec3(cut.normal), view.eye))});
  }
  [[gnu::always_inline]] EightDiscs eight(const NodePoints& node, size_t first) const;
  [[gnu::always_inline]] Lanes own_radius(const NodePoints& node, size_t first) const;
};

[[gnu::always_inline]] inline Lanes3 turned(const ToEye& m, const Lanes3& n) {
  return {m.turn[0].x * n.x + m.turn[1].x * n.y + m.turn[2].x * n.z,
          m.turn[0].y * n.x + m.turn[1].y * n.y + m.turn[2].y * n.z,
          m.turn[0].z * n.x + m.turn[1].z * n.y + m.turn[2].z * n.z};
}

// Returns the radii of discs, metres.
inline Lanes Projection::own_radius(const NodePoints& node, size_t first) const {
  if (spheres || !node.own_spacing) return all_lanes(radius);
  const Lanes own = __builtin_convertvector(load_lanes<Bytes>(node.own_spacing + first), Lanes) *
                    (1 / own_spacing_steps);
  const LaneMask grows = (own > all_lanes(sparse_from)) & (own < all_lanes(alone_from));
  return radius * (grows ? lanes_min(own, all_lanes(most_growth)) : all_lanes(1));
}

inline EightDiscs Projection::eight(const NodePoints& node, size_t first) const {
  EightDiscs d;
  const Lanes px = whole_lanes(load_words(node.x + first)),
              py = whole_lanes(load_words(node.y + first)),
              pz = whole_lanes(load_words(node.z + first));
  const ToEye& m = to_eye;
  const Lanes3 at{m.shift.x + px * m.x.x + py * m.y.x + pz * m.z.x,
                  m.shift.y + px * m.x.y + py * m.y.y + pz * m.z.y,
                  m.shift.z + px * m.x.z + py * m.y.z + pz * m.z.z};
  d.seen = at.z >= all_lanes(near);
  for (const ScanCut& cut : cuts) d.seen &= dot(at, all_lanes(cut.normal)) >= cut.offset;
  d.depth = at.z;
  const Lanes scale = focal / lanes_max(at.z, all_lanes(near));
  const Lanes place_x = clamp_lanes(axis_x + at.x * scale, -outside_places, outside_places);
  const Lanes place_y = clamp_lanes(axis_y - at.y * scale, -outside_places, outside_places);
  const Lanes wanted = own_radius(node, first) * scale;
  const Lanes r = clamp_lanes(wanted, least_radius, most_pixels);
  const LaneMask single = wanted < all_lanes(single_below);
  d.large = spheres ? wanted > all_lanes(most_pixels) : LaneMask{};

  // The plane's slope at the middle: how much farther it is a pixel on, in pixels' sizes.
  const LaneMask word = spheres ? LaneMask{} + no_point_normal : load_words(node.normal + first);
  const Lanes3 n = turned(m, fold_normals(unpack_normals(word)));
  const Lanes along = dot(n, at);
  const Lanes least = at.z * 1e-4f;
  const Lanes safe = lanes_abs(along) < least ? least : along;
  const Lanes ratio = keep_lanes(word != no_point_normal, -at.z / safe);
  const Lanes steep_x = ratio * n.x, steep_y = -ratio * n.y;
  const Lanes steep2 = steep_x * steep_x + steep_y * steep_y;
  const Lanes kept2 = lanes_min(steep2, all_lanes(steepest * steepest));
  const Lanes square = r * r;
  const Lanes limit = square * (1 / (least_narrow * least_narrow)) - 1;
  const Lanes shown2 = lanes_min(kept2, limit);
  // Slopes are cut to `steepest`, shapes to `least_narrow`.
  const Lanes tiny = all_lanes(1e-20f);
  const Lanes thin = lanes_sqrt(shown2 / lanes_max(steep2, tiny)) / r;
  d.lean_x = steep_x * thin, d.lean_y = steep_y * thin;
  d.slope = lanes_sqrt(kept2 / lanes_max(shown2, tiny)) * r / scale;
  d.radius = d.large ? wanted : r;

  const Lanes x2 = d.lean_x * d.lean_x * square, y2 = d.lean_y * d.lean_y * square;
  const Lanes share = square / (1 + x2 + y2);
  const LaneMask extent_x = LaneMask(to_whole(lanes_sqrt(share * (1 + y2)) * 4)) + 1;
  const LaneMask extent_y = LaneMask(to_whole(lanes_sqrt(share * (1 + x2)) * 4)) + 1;
  const LaneMask fixed_x = round_lanes(place_x * 256), fixed_y = round_lanes(place_y * 256);
  const LaneMask kept_x = single ? LaneMask{} : extent_x, kept_y = single ? LaneMask{} : extent_y;
  d.x = (fixed_x << 8) | kept_x, d.y = (fixed_y << 8) | kept_y;
  // The pixel next to a place is 128/256 around it, the lower border included.
  const LaneMask low_add = single ? LaneMask{} + 128 : 255 - extent_x * 64;
  const LaneMask high_add = single ? LaneMask{} + 128 : extent_x * 64;
  const LaneMask low_add_y = single ? LaneMask{} + 128 : 255 - extent_y * 64;
  const LaneMask high_add_y = single ? LaneMask{} + 128 : extent_y * 64;
  d.low_x = (fixed_x + low_add) >> 8, d.high_x = (fixed_x + high_add) >> 8;
  d.low_y = (fixed_y + low_add_y) >> 8, d.high_y = (fixed_y + high_add_y) >> 8;
  d.low_x = d.low_x < 0 ? LaneMask{} : d.low_x;
  d.low_y = d.low_y < 0 ? LaneMask{} : d.low_y;
  d.high_x = d.high_x > width - 1 ? LaneMask{} + (width - 1) : d.high_x;
  d.high_y = d.high_y > height - 1 ? LaneMask{} + (height - 1) : d.high_y;
  d.seen &= ((d.low_x <= d.high_x) & (d.low_y <= d.high_y)) | d.large;
  return d;
}

void store_discs(Disc* to, const EightDiscs& d, uint32_t point) {
  const LaneMask number = LaneMask{0, 1, 2, 3, 4, 5, 6, 7} + int(point);
  Lanes rows[lane_count] = {
      lanes_as<Lanes>(d.x),   lanes_as<Lanes>(d.y), d.depth, d.lean_x, d.lean_y, d.radius, d.slope,
      lanes_as<Lanes>(number)};
  transpose_lanes(rows);
  for (int i = 0; i < lane_count; i++) store_lanes(to + i, rows[i]);
}

// Lists which disc is in which tile.
struct Entries {
  std::array<Disc, piece_points> discs;                          // one a point
  std::array<uint32_t, size_t(4) * piece_points> tile_and_disc;  // tile << piece_bits | disc
  size_t count = 0;
  std::vector<uint32_t> of_tile;  // number of the tile's run, or none
  std::vector<TileDiscs> runs;
  static constexpr uint32_t none = 0xffffffffu;

  void start(size_t tiles) {
    if (of_tile.size() != tiles) of_tile.assign(tiles, none);
    for (const TileDiscs& run : runs) of_tile[run.tile] = none;
    runs.clear();
    count = 0;
  }
  void add(uint32_t tile, uint32_t disc) {
    uint32_t& run = of_tile[tile];
    if (run == none) {
      run = uint32_t(runs.size());
      runs.push_back({.tile = tile});
    }
    runs[run].end++;
    const Disc& d = discs[disc];
    runs[run].area += 1 + uint32_t((d.x & 255) * (d.y & 255)) / 4;
    tile_and_disc[count++] = tile << piece_bits | disc;
  }
};

// Returns whether a sphere touches the pyramid that the picture shows.
bool is_in_picture(const Disc& sphere, const ScanCamera& view) {
  const float pixel = 1 / view.focal(), radius = sphere.radius * sphere.depth * pixel;
  const vec2 axis = view.axis_place();
  const vec2 at = place_of(sphere) + view.offset - axis;
  const auto is_beyond = [&](float place, float edge) {
    const float tangent = edge * pixel;
    return (place - edge) * pixel * sphere.depth > radius * std::sqrt(1 + tangent * tangent);
  };
  return !is_beyond(at.x, float(view.width) - axis.x) && !is_beyond(-at.x, axis.x) &&
         !is_beyond(at.y, float(view.height) - axis.y) && !is_beyond(-at.y, axis.y);
}

}  // namespace

float large_reach(const Disc& sphere, const ScanCamera& view) {
  const float pixel = 1 / view.focal(), radius = sphere.radius * sphere.depth * pixel;
  const float front = sphere.depth - radius;
  if (!(front > 0.1f * radius)) return float(view.width + view.height);
  const vec2 at = place_of(sphere);
  const vec2 own = (at - (view.axis_place() - view.offset)) * pixel;
  return sphere.radius * sphere.depth / front * sphere.depth / front *
             std::sqrt(1 + dot(own, own)) +
         1;
}

void PieceDiscs::make(const Piece& piece, uint32_t number, const NodePoints& node,
                      const ScanCamera& view, const DiscStyle& style) {
  static thread_local std::unique_ptr<Entries> kept;
  if (!kept) kept = std::make_unique<Entries>();
  Entries& entries = *kept;
  const int tiles_x = (view.width + tile_side - 1) / tile_side;
  const int tiles_y = (view.height + tile_side - 1) / tile_side;
  entries.start(size_t(tiles_x) * size_t(tiles_y));
  large_.clear();
  const Projection projection(node, view, style);
  constexpr LaneMask numbers{0, 1, 2, 3, 4, 5, 6, 7};
  for (uint32_t i = 0; i < piece.count; i += lane_count) {
    const EightDiscs d = projection.eight(node, piece.first + i);
    unsigned seen = negative_lanes(d.seen & (numbers < int(piece.count - i)));
    if (seen == 0) continue;
    store_discs(&entries.discs[i], d, number << piece_bits | i);
    for (unsigned large = seen & negative_lanes(d.large); large != 0; large &= large - 1) {
      const Disc& sphere = entries.discs[i + uint32_t(std::countr_zero(large))];
      if (is_in_picture(sphere, view)) large_.push_back(sphere);
    }
    seen &= ~negative_lanes(d.large);
    const LaneMask x = d.low_x >> 6, y = d.low_y >> 6;
    const LaneMask more_x = (d.high_x >> 6) - x, more_y = (d.high_y >> 6) - y;
    const LaneMask tile = y * tiles_x + x;
    const unsigned several = negative_lanes((more_x | more_y) > 0);
    for (; seen != 0; seen &= seen - 1) {
      const int lane = std::countr_zero(seen);
      const uint32_t disc = i + uint32_t(lane), at = uint32_t(tile[lane]);
      entries.add(at, disc);
      if ((several >> lane & 1) == 0) continue;
      if (more_x[lane] > 0) entries.add(at + 1, disc);
      if (more_y[lane] > 0) entries.add(at + uint32_t(tiles_x), disc);
      if (more_x[lane] > 0 && more_y[lane] > 0) entries.add(at + uint32_t(tiles_x) + 1, disc);
    }
  }
  if (room_ < entries.count) {
    room_ = std::max<size_t>(entries.count, piece_points);
    discs_ = std::make_unique_for_overwrite<Disc[]>(room_);
  }
  uint32_t begin = 0;
  for (TileDiscs& run : entries.runs) {
    const uint32_t size = run.end;
    run.begin = run.end = begin;
    begin += size;
  }
  for (size_t i = 0; i < entries.count; i++) {
    const uint32_t entry = entries.tile_and_disc[i];
    TileDiscs& run = entries.runs[entries.of_tile[entry >> piece_bits]];
    discs_[run.end++] = entries.discs[entry & (piece_points - 1)];
  }
  runs_.assign(entries.runs.begin(), entries.runs.end());
}

bool may_see_node(const NodePoints& node, const ScanCamera& view, const DiscStyle& style) {
  if (node.count == 0) return false;
  for (const ScanCut& cut : view.cuts)
    if (CutReach(node, cut).kept < 0) return false;
  const dvec3 from = node.corner + dvec3(0.5 * double(node.size)) - view.eye;
  const vec3 middle(dot(from, dvec3(view.right)), dot(from, dvec3(view.up)),
                    dot(from, dvec3(view.forward)));
  const float reach = 0.8661f * node.size;
  if (middle.z + reach < std::max(view.near, nearest_depth)) return false;
  // Discs that are not in the picture may reach into it.
  const float beyond = 1 + style.most_pixels, focal = view.focal();
  const vec2 axis = view.axis_place();
  const auto outside = [&](float across, float tangent, float sign) {
    return sign * (across - tangent * middle.z) > reach * std::sqrt(1 + tangent * tangent);
  };
  return !outside(middle.x, (float(view.width) - axis.x + beyond) / focal, 1) &&
         !outside(middle.x, (-axis.x - beyond) / focal, -1) &&
         !outside(middle.y, (axis.y + beyond) / focal, 1) &&
         !outside(middle.y, (axis.y - float(view.height) - beyond) / focal, -1);
}

}  // namespace wellspring::scan
