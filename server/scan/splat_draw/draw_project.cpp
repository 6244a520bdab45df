// SPDX-License-Identifier: Apache-2.0
#include "scan/splat_draw/draw_project.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/parallel.h"
#include "scan/splat_draw/draw_lanes.h"

namespace wellspring::scan {
namespace {

constexpr uint32_t blocks_a_piece = 64;

// Some blocks of a node, and where what they become begins.
struct BlockPiece {
  uint32_t set, first, count;
  size_t begin = 0;
  uint32_t drawn = 0;
};

struct Lanes2 {
  Lanes x, y;
};

// Holds the same for all of a set's splats.
struct Projection {
  LocalView view;
  ProjectSettings settings;
  float width, height;
  float left, right, top, bottom;  // ratios beyond which slants stay the same

  Projection(const LocalView& local, const ScanCamera& whole, const ProjectSettings& settings)
      : view(local), settings(settings), width(float(whole.width)), height(float(whole.height)) {
    // As in the reference's program: 15 % of the picture beyond its edges.
    const float x = 0.15f * width / view.focal, y = 0.15f * height / view.focal;
    left = -whole.axis_place().x / view.focal - x;
    right = (width - whole.axis_place().x) / view.focal + x;
    top = -whole.axis_place().y / view.focal - y;
    bottom = (height - whole.axis_place().y) / view.focal + y;
  }
};

struct DrawnLanes {
  Lanes x, y, lean, fall_x, fall_y, opacity;
  Lanes3 color;
  Lanes nearness, slope_x, slope_y, farthest, nearest, depth, left, right, top, bottom;
  unsigned seen;  // lane i as bit i
};

// The axes of eight ellipsoids, to one standard deviation.
void make_axes(const SplatBlock& b, Lanes3 (&axes)[3]) {
  const Lanes x = b.turn_x, y = b.turn_y, z = b.turn_z, w = b.turn_w;
  axes[0] = Lanes3{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)} * b.scale.x;
  axes[1] = Lanes3{2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)} * b.scale.y;
  axes[2] = Lanes3{2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)} * b.scale.z;
}

inline Lanes3 along_axes(const Lanes3 (&axes)[3], const Lanes3& d) {
  return {dot(axes[0], d), dot(axes[1], d), dot(axes[2], d)};
}

inline Lanes3 cross_lanes(const Lanes3& a, const Lanes3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

void project_block(DrawnLanes& out, const Projection& p, const ShownSplats& splats, size_t at) {
  const SplatBlock& block = splats.blocks[at];
  const LocalView& view = p.view;
  const Lanes3 away = block.place - all_lanes(view.eye);
  const Lanes depth = dot(away, all_lanes(view.forward));
  LaneMask seen = (depth > view.near) & (block.opacity >= splat_threshold);
  for (const ScanCut& cut : view.cuts)
    seen &= dot(block.place, all_lanes(cut.normal)) >= cut.offset;
  out.seen = 0;
  if (!any_lane(seen)) return;
  const Lanes part = 1 / depth;
  const Lanes x = dot(away, all_lanes(view.right)) * part;
  const Lanes y = -dot(away, all_lanes(view.up)) * part;
  out.x = x * view.focal + view.axis.x;
  out.y = y * view.focal + view.axis.y;

  // Rows of the Jacobian in the set's frame times the ellipsoids' axes.
  Lanes3 axes[3];
  make_axes(block, axes);
  const Lanes3 forward = along_axes(axes, all_lanes(view.forward));
  const Lanes focal = view.focal * part;
  const Lanes slant_x = lanes_min(lanes_max(x, all_lanes(p.left)), all_lanes(p.right));
  const Lanes slant_y = lanes_min(lanes_max(y, all_lanes(p.top)), all_lanes(p.bottom));
  const Lanes3 across = (along_axes(axes, all_lanes(view.right)) - forward * slant_x) * focal;
  const Lanes3 down = (along_axes(axes, all_lanes(-view.up)) - forward * slant_y) * focal;

  const float blur = p.settings.blur;
  const Lanes xx = dot(across, across) + blur, yy = dot(down, down) + blur;
  const Lanes xy = dot(across, down);
  // The determinant is a sum of squares (Binet and Cauchy): it is exact for thin splats, too.
  const Lanes3 area = cross_lanes(across, down);
  const Lanes sharp = dot(area, area);
  const Lanes det = sharp + blur * (xx + yy - blur);
  Lanes opacity = block.opacity;
  if (!p.settings.keep_opacity) opacity = opacity * lanes_sqrt(sharp / det);
  seen &= (opacity >= splat_threshold) & (det > 0) & (det < 1e36f);
  opacity = seen ? opacity : all_lanes(1);
  out.opacity = log_of_two(opacity);
  const Lanes reach = (out.opacity - log_threshold) * 1.38629436f;  // square deviations
  const Lanes wide = lanes_sqrt(reach * xx), high = lanes_sqrt(reach * yy);
  out.left = lanes_max(out.x - wide, Lanes{}), out.right = out.x + wide;
  out.top = lanes_max(out.y - high, Lanes{}), out.bottom = out.y + high;
  // Lanes are cut off to whole numbers: to the next pixel at the left and the top.
  out.right = lanes_min(out.right, all_lanes(p.width - 1));
  out.bottom = lanes_min(out.bottom, all_lanes(p.height - 1));
  seen &= (out.left <= out.right) & (out.top <= out.bottom);
  out.seen = negative_lanes(seen);
  if (out.seen == 0) return;

  const Lanes inverse_yy = 1 / yy, across_square = det * inverse_yy;
  out.lean = xy * inverse_yy;
  out.fall_y = 0.72134752f * inverse_yy;
  out.fall_x = 0.72134752f / across_square;
  const Lanes metres = 1 / view.scale * part;
  const Lanes3 nearer = forward * (-part * metres);
  const Lanes with_y = dot(nearer, down);
  out.nearness = metres;
  out.slope_y = with_y * inverse_yy;
  out.slope_x = (dot(nearer, across) - out.lean * with_y) / across_square;
  const Lanes deep = lanes_sqrt(reach * dot(forward, forward));
  out.farthest = 1 / ((depth + deep) * view.scale);
  out.nearest = 1 / (lanes_max(depth - deep, all_lanes(view.near)) * view.scale);
  out.depth = depth * view.scale;

  const Lanes3 direction = away * (1 / lanes_sqrt(dot(away, away)));
  out.color = seen_color(splats.block_codes(at).data(), splats.degree, all_lanes(block.color_scale),
                         all_lanes(block.harmonics_scale), direction);
  out.color = {positive_lanes(out.color.x), positive_lanes(out.color.y),
               positive_lanes(out.color.z)};
}

// Writes the lanes that are seen; returns how many.
uint32_t keep_seen(DrawnSplats& drawn, size_t to, const DrawnLanes& lanes, bool nearest_first) {
  const LaneMask left = LaneMask(to_whole(lanes.left + 0.9999f)),
                 top = LaneMask(to_whole(lanes.top + 0.9999f)),
                 right = LaneMask(to_whole(lanes.right)), bottom = LaneMask(to_whole(lanes.bottom));
  Lanes first[lane_count] = {lanes.x,      lanes.y,       lanes.lean,    lanes.fall_x,
                             lanes.fall_y, lanes.opacity, lanes.color.x, lanes.color.y};
  Lanes second[lane_count] = {lanes.color.z,  lanes.nearness, lanes.slope_x, lanes.slope_y,
                              lanes.farthest, lanes.nearest,  Lanes{},       Lanes{}};
  transpose_lanes(first);
  transpose_lanes(second);
  uint32_t count = 0;
  for (unsigned rest = lanes.seen; rest != 0; rest &= rest - 1) {
    const int lane = std::countr_zero(rest);
    if (left[lane] > right[lane] || top[lane] > bottom[lane]) continue;
    DrawnSplat& splat = drawn.splats[to + count];
    char* words = reinterpret_cast<char*>(&splat);
    store_lanes(words, first[lane]);
    store_lanes(words + sizeof(Lanes), second[lane]);
    splat.box = {int16_t(left[lane]), int16_t(top[lane]), int16_t(right[lane]),
                 int16_t(bottom[lane])};
    drawn.boxes[to + count] = splat.box;
    const float depth = nearest_first ? 1 / lanes.nearest[lane] : lanes.depth[lane];
    drawn.keys[to + count] = {std::bit_cast<uint32_t>(depth), uint32_t(to + count)};
    count++;
  }
  return count;
}

}  // namespace

static_assert(sizeof(DrawnSplat) == 64);

void project_splats(DrawnSplats& drawn, std::span<const PlacedSplats> sets, const ScanCamera& view,
                    const ProjectSettings& settings) {
  std::vector<LocalView> views;
  std::vector<Projection> projections;
  for (const PlacedSplats& set : sets) {
    views.push_back(make_local_view(set, view));
    projections.emplace_back(views.back(), view, settings);
  }
  std::vector<BlockPiece> pieces;
  size_t places = 0;
  drawn.looked_at = 0;
  for (const ChosenSplats& chosen :
       choose_splats(sets, views, settings.cell_pixels, settings.budget)) {
    const SplatNode& node = sets[chosen.set].splats->nodes[chosen.node];
    const uint32_t end = node.first + (node.count + lane_count - 1) / lane_count;
    for (uint32_t first = node.first; first < end; first += blocks_a_piece) {
      pieces.push_back({chosen.set, first, std::min(blocks_a_piece, end - first), places});
      places += pieces.back().count * lane_count;
    }
    drawn.looked_at += node.count;
  }
  if (drawn.splats.size() < places) drawn.splats.resize(places), drawn.boxes.resize(places);
  drawn.keys.resize(places);
  parallel_ranges(int(pieces.size()), 4, [&](int begin, int end) {
    DrawnLanes lanes;
    for (int i = begin; i < end; i++) {
      BlockPiece& piece = pieces[size_t(i)];
      for (uint32_t b = 0; b < piece.count; b++) {
        project_block(lanes, projections[piece.set], *sets[piece.set].splats, piece.first + b);
        if (lanes.seen != 0)
          piece.drawn += keep_seen(drawn, piece.begin + piece.drawn, lanes, settings.nearest_first);
      }
    }
  });
  // Keys move together; their order stays.
  size_t count = 0;
  for (const BlockPiece& piece : pieces) {
    std::copy_n(drawn.keys.begin() + ptrdiff_t(piece.begin), piece.drawn,
                drawn.keys.begin() + ptrdiff_t(count));
    count += piece.drawn;
  }
  drawn.keys.resize(count);
}

}  // namespace wellspring::scan
