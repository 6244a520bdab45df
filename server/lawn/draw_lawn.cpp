// SPDX-License-Identifier: Apache-2.0
#include "lawn/draw_lawn.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "lawn/fill_strips.h"

namespace wellspring::lawn {
namespace {

constexpr float no_depth = std::numeric_limits<float>::infinity();
constexpr float least_depth = 0.02f;  // metres; strips that come nearer are not drawn
constexpr float taper[joints] = {0.75f, 1, 0.7f, 0};  // share of the width at the joints
constexpr float roundness = 0.7f;  // how far normals turn from the middle to an edge
// This share of the blades that a distance shows becomes thin.
constexpr float blend = 0.25f;

bool is_good(const LawnView& view) {
  constexpr int most = LawnDrawer::most_side;
  return view.width > 0 && view.height > 0 && view.width <= most && view.height <= most &&
         is_finite(view.eye) && is_finite(view.right) && is_finite(view.up) &&
         is_finite(view.forward) && view.tan_half_fov > 0 && view.tan_half_fov < 1e4f &&
         is_finite(vec3(view.axis, view.near)) && is_finite(vec3(view.offset, 0));
}

float focal_of(const LawnView& view) { return 0.5f * float(view.height) / view.tan_half_fov; }

// Returns which share of its blades a depth shows; more than 1: all, and none of them thin.
float shown_share(const LawnView& view, const LawnDrawSettings& settings, float width,
                  float depth) {
  const float pixels = width * focal_of(view) / std::max(depth, least_depth);
  return pixels / std::max(settings.least_width, 1e-3f);
}

// Holds the picture's part that a box meets, and its least depth.
struct BoxInPicture {
  vec2 low{no_depth}, high{-no_depth};  // pixels
  float depth = no_depth;
  bool is_seen = false;
};
BoxInPicture find_box(const LawnView& view, vec3 low, vec3 high) {
  BoxInPicture box;
  const float focal = focal_of(view);
  bool crosses = false;
  float most = -no_depth;
  for (int i = 0; i < 8; i++) {
    const vec3 d =
        vec3(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z) - view.eye;
    const float depth = dot(d, view.forward);
    box.depth = std::min(box.depth, depth), most = std::max(most, depth);
    if (depth < least_depth) {
      crosses = true;
      continue;
    }
    const vec2 at = view.axis + focal / depth * vec2(dot(d, view.right), -dot(d, view.up));
    box.low = min(box.low, at), box.high = max(box.high, at);
  }
  if (most < std::max(least_depth, view.near)) return box;
  const vec2 size(view.width, view.height);
  if (crosses) {
    // Corners behind the eye have no place: the box is out of sight if it is beyond one side.
    const vec3 side[4] = {view.right * focal + view.forward * view.axis.x,
                          -view.right * focal + view.forward * (size.x - view.axis.x),
                          -view.up * focal + view.forward * view.axis.y,
                          view.up * focal + view.forward * (size.y - view.axis.y)};
    for (const vec3& s : side) {
      const vec3 best = {s.x > 0 ? high.x : low.x, s.y > 0 ? high.y : low.y,
                         s.z > 0 ? high.z : low.z};
      if (dot(best - view.eye, s) < 0) return box;
    }
    box.low = vec2(0), box.high = size - 1.0f;
  }
  box.low = max(box.low, vec2(0)), box.high = min(box.high, size - 1.0f);
  box.is_seen = box.low.x <= box.high.x && box.low.y <= box.high.y;
  return box;
}

}  // namespace

void LawnDrawer::find_seen(const Lawn& lawn, const LawnState& state, const LawnView& view,
                           const LawnDrawSettings& settings) {
  seen_.clear();
  for (int i = 0; i < int(lawn.tile.size()); i++) {
    const LawnTile& tile = lawn.tile[size_t(i)];
    if (tile.count == 0) continue;
    const BentTile& bent = state.bent[size_t(i)];
    const bool is_bent = !bent.touched.empty();
    const BoxInPicture box = find_box(view, is_bent ? min(tile.low, bent.low) : tile.low,
                                      is_bent ? max(tile.high, bent.high) : tile.high);
    if (!box.is_seen) continue;
    Seen seen;
    seen.tile = i, seen.depth = box.depth;
    seen.low = max((ivec2(box.low) - 1) / ivec2(bin_width, bin_height), ivec2(0));
    seen.high = min((ivec2(box.high) + 1) / ivec2(bin_width, bin_height), bins_ - 1);
    bool hidden = true;
    for (int y = seen.low.y; y <= seen.high.y && hidden; y++)
      for (int x = seen.low.x; x <= seen.high.x && hidden; x++)
        hidden = farthest_[size_t(y * bins_.x + x)] < seen.depth;
    if (hidden) continue;
    const float share = shown_share(view, settings, tile.widest, seen.depth);
    seen.most = share >= 1 ? tile.count : std::min(int(share * float(tile.count)) + 1, tile.count);
    seen_.push_back(seen);
  }
  std::ranges::sort(seen_, [](const Seen& a, const Seen& b) {
    return a.depth != b.depth ? a.depth < b.depth : a.tile < b.tile;
  });
  int first = 0;
  for (Seen& seen : seen_) {
    seen.first = first;
    first += (seen.most + lane_count - 1) / lane_count * lane_count;
  }
  if (strips_.size() < size_t(first)) strips_.resize(size_t(first)), boxes_.resize(size_t(first));
}

void LawnDrawer::project(const Lawn& lawn, const LawnState& state, const WindNow& wind,
                         const LawnView& view, const LawnDrawSettings& settings, Seen& seen) {
  const LawnTile& tile = lawn.tile[size_t(seen.tile)];
  const float focal = focal_of(view), wanted = std::max(settings.least_width, 1e-3f);
  const Lanes3 right = all_lanes(view.right), up = all_lanes(view.up),
               forward = all_lanes(view.forward);
  const Lanes rank_step = Lanes{0, 1, 2, 3, 4, 5, 6, 7};
  seen.count = 0;
  for (int at = 0; at < seen.most; at += lane_count) {
    const size_t first = size_t(tile.begin + at);
    const BladeShapes shapes = eval_shapes(lawn, state, wind, seen.tile, int(first));
    const BladeSway sway = eval_sway(lawn, int(first), shapes);
    // Which of them the root's depth shows, and how wide.
    const Lanes root_depth =
        lanes_max(dot(shapes.joint[0] - all_lanes(view.eye), forward), all_lanes(least_depth));
    Lanes width = load_lanes(&lawn.width[first]);
    const Lanes rank = (rank_step + float(at) + 0.5f) * (1 / float(tile.count));
    const Lanes share =
        lanes_min(width * (focal / wanted) / root_depth, all_lanes(1 / (1 - blend)));
    const Lanes thin =
        lanes_max(lanes_min((share - rank) / (share * blend + 1e-9f), all_lanes(1)), Lanes{});
    width *= thin / lanes_min(share * (1 - blend / 2), all_lanes(1));
    LaneMask shown = (rank < 1.0f) & (width > 0.0f) & (shapes.length > 0.0f);
    if (!any_lane(shown)) continue;

    Lanes x[joints], y[joints], inverse[joints], half_x[joints], half_y[joints];
    Lanes3 normal[joints];
    Lanes3 edge = {load_lanes(&lawn.side_x[first]), Lanes{}, load_lanes(&lawn.side_z[first])};
    const Lanes3 face = {-edge.z, Lanes{}, edge.x};
    Lanes low_x = all_lanes(no_depth), low_y = low_x, high_x = -low_x, high_y = -low_x;
    Lanes facing{};
    for (int k = 0; k < joints; k++) {
      const Lanes3 d = shapes.joint[k] - all_lanes(view.eye);
      const Lanes depth = dot(d, forward);
      shown &= depth > least_depth;
      inverse[k] = 1.0f / lanes_max(depth, all_lanes(least_depth));
      const Lanes scale = inverse[k] * focal;
      const Lanes aside = dot(d, right) * inverse[k], above = dot(d, up) * inverse[k];
      x[k] = view.axis.x + aside * focal, y[k] = view.axis.y - above * focal;
      const Lanes3 way =
          unit_lanes(shapes.joint[std::min(k + 1, segments)] - shapes.joint[std::max(k - 1, 0)]);
      // A strip that lies along its own side turns over its face.
      normal[k] = unit_lanes(cross(edge, way) + face * all_lanes(0.01f));
      const Lanes3 side = cross(way, normal[k]);
      const Lanes half = 0.5f * taper[k] * width * scale;
      const Lanes away = dot(side, forward);
      half_x[k] = half * (dot(side, right) - aside * away);
      half_y[k] = -half * (dot(side, up) - above * away);
      facing -= dot(normal[k], d);
      const Lanes wide_x = lanes_abs(half_x[k]), wide_y = lanes_abs(half_y[k]);
      low_x = lanes_min(low_x, x[k] - wide_x), high_x = lanes_max(high_x, x[k] + wide_x);
      low_y = lanes_min(low_y, y[k] - wide_y), high_y = lanes_max(high_y, y[k] + wide_y);
    }
    shown &= (high_x >= 0.0f) & (low_x < float(view.width)) & (high_y >= 0.0f) &
             (low_y < float(view.height));
    const Lanes flip = facing < 0.0f ? all_lanes(-1) : all_lanes(1);
    const Lanes dry = load_lanes(&lawn.dry[first]) * lawn.colors.dryness;

    for (unsigned left = negative_lanes(shown); left != 0; left &= left - 1) {
      const int lane = __builtin_ctz(left);
      const size_t to = size_t(seen.first + seen.count++);
      const auto pixel = [](float p, int size) {
        return int16_t(std::clamp(std::floor(p), 0.0f, float(size - 1)));
      };
      boxes_[to] = {pixel(low_x[lane], view.width), pixel(low_y[lane], view.height),
                    pixel(high_x[lane], view.width), pixel(high_y[lane], view.height)};
      Strip& strip = strips_[to];
      const vec3 tip = mix(lawn.colors.fresh, lawn.colors.dry, dry[lane]);
      for (int k = 0; k < joints; k++) {
        strip.x[k] = x[k][lane], strip.y[k] = y[k][lane], strip.inverse[k] = inverse[k][lane];
        strip.half_x[k] = half_x[k][lane], strip.half_y[k] = half_y[k][lane];
        const vec3 n = flip[lane] * normal[k].at(lane);
        const float part = float(k) / segments;
        const vec3 color = mix(lawn.colors.root, tip, std::min(1.5f * part, 1.0f));
        strip.value[k] = Lanes{n.x, n.y, n.z, color.x, color.y, color.z, part, sway.joint[k][lane]};
      }
      const vec3 turn = roundness * edge.at(lane);
      strip.aside = Lanes{turn.x, turn.y, turn.z, 0, 0, 0, 0, 0};
    }
  }
}

void LawnDrawer::put_in_bins() {
  bin_begin_.assign(size_t(bins_.x * bins_.y) + 1, 0);
  const auto for_bins = [&](const Seen& seen, const auto& body) {
    for (int y = seen.low.y; y <= seen.high.y; y++)
      for (int x = seen.low.x; x <= seen.high.x; x++) body(size_t(y * bins_.x + x));
  };
  for (const Seen& seen : seen_)
    if (seen.count > 0) for_bins(seen, [&](size_t bin) { bin_begin_[bin + 1]++; });
  for (size_t i = 1; i < bin_begin_.size(); i++) bin_begin_[i] += bin_begin_[i - 1];
  bin_seen_.resize(size_t(bin_begin_.back()));
  std::vector<int> next(bin_begin_.begin(), bin_begin_.end() - 1);
  for (size_t i = 0; i < seen_.size(); i++)
    if (seen_[i].count > 0)
      for_bins(seen_[i], [&](size_t bin) { bin_seen_[size_t(next[bin]++)] = int(i); });
}

// Fills the strips of one bin at a time.
struct LawnDrawer::Filler {
  const LawnDrawer& drawer;
  const LawnView& view;
  const LawnDrawSettings& settings;
  LawnPicture& picture;

  void operator()(int bin) const {
    BinPixels pixels;
    pixels.x = bin % drawer.bins_.x * bin_width, pixels.y = bin / drawer.bins_.x * bin_height;
    pixels.width = std::min(bin_width, view.width - pixels.x);
    pixels.height = std::min(bin_height, view.height - pixels.y);
    pixels.near = view.near;
    pixels.offset = view.offset, pixels.coverage = settings.coverage;
    const bool some = drawer.bin_begin_[size_t(bin)] < drawer.bin_begin_[size_t(bin) + 1];
    if (some) {
      pixels.clear(settings.before, view.width);
      for (int i = drawer.bin_begin_[size_t(bin)]; i < drawer.bin_begin_[size_t(bin) + 1]; i++)
        fill(drawer.seen_[size_t(drawer.bin_seen_[size_t(i)])], bin, pixels);
    }
    for (int y = 0; y < pixels.height; y++) {
      const size_t row = size_t(pixels.y + y) * size_t(view.width) + size_t(pixels.x);
      if (some) take_row(pixels, y, row);
      else clear_row(row, pixels.width);
    }
  }

  void clear_row(size_t row, int count) const {
    std::fill_n(&picture.depth[row], count, no_depth);
    std::fill_n(&picture.normal[row], count, vec3(0));
    std::fill_n(&picture.color[row], count, vec3(0));
    std::fill_n(&picture.height_share[row], count, 0.0f);
    std::fill_n(&picture.sway[row], count, 0.0f);
    std::fill_n(&picture.coverage[row], count, 0.0f);
  }

  // Puts the means of what covers a row's pixels into the picture from `row` on.
  void take_row(const BinPixels& pixels, int y, size_t row) const {
    for (int x = 0; x < pixels.width; x += lane_count) {
      const size_t from = size_t(y * bin_width + x), to = row + size_t(x);
      const int count = std::min(pixels.width - x, lane_count);
      const Lanes cover = load_lanes(&pixels.covered[from]);
      const LaneMask some = cover > 0.0f;
      if (!any_lane(some)) {
        clear_row(to, count);
        continue;
      }
      Lanes value[lane_count];
      for (int i = 0; i < lane_count; i++)
        value[i] = some[i] ? pixels.value[from + size_t(i)] : Lanes{};
      transpose_lanes(value);
      const Lanes scale = keep_lanes(some, 1.0f / (some ? cover : all_lanes(1)));
      const Lanes3 normal = {value[0], value[1], value[2]};
      const Lanes length2 = dot(normal, normal);
      const LaneMask has_way = length2 > 1e-12f;
      const Lanes per_length = 1.0f / lanes_sqrt(has_way ? length2 : all_lanes(1));
      const Lanes3 unit =
          choose(some, choose(has_way, normal * per_length, all_lanes(-view.forward)), Lanes3{});
      const Lanes3 color = Lanes3{value[3], value[4], value[5]} * scale;
      for (int i = 0; i < count; i++) {
        picture.normal[to + size_t(i)] = unit.at(i);
        picture.color[to + size_t(i)] = color.at(i);
      }
      const auto store = [&](std::vector<float>& plane, const Lanes& values) {
        if (count == lane_count) store_lanes(&plane[to], values);
        else
          for (int i = 0; i < count; i++) plane[to + size_t(i)] = values[i];
      };
      store(picture.depth, some ? load_lanes(&pixels.depth[from]) : all_lanes(no_depth));
      store(picture.height_share, value[6] * scale);
      store(picture.sway, value[7] * scale);
      store(picture.coverage, lanes_min(cover, all_lanes(1)));
    }
  }

  void fill(const Seen& seen, int bin, BinPixels& pixels) const {
    if (drawer.farthest_[size_t(bin)] < seen.depth) return;
    const int right = pixels.x + pixels.width, bottom = pixels.y + pixels.height;
    for (int i = seen.first; i < seen.first + seen.count; i++) {
      const Box& box = drawer.boxes_[size_t(i)];
      if (box.x1 < pixels.x || box.x0 >= right || box.y1 < pixels.y || box.y0 >= bottom) continue;
      fill_strip(pixels, drawer.strips_[size_t(i)]);
    }
  }
};

LawnCounts LawnDrawer::draw(const Lawn& lawn, const LawnState& state, const Wind& wind,
                            const LawnView& view, const LawnDrawSettings& settings,
                            LawnPicture& picture) {
  LawnCounts counts;
  if (!is_good(view)) {
    picture = {};
    return counts;
  }
  picture.width = view.width, picture.height = view.height;
  const size_t size = size_t(view.width) * size_t(view.height);
  picture.depth.resize(size), picture.normal.resize(size), picture.color.resize(size);
  picture.height_share.resize(size), picture.sway.resize(size);
  picture.coverage.resize(size);

  LawnDrawSettings checked = settings;
  if (checked.before.size() != size) checked.before = {};
  bins_ = (ivec2(view.width, view.height) + ivec2(bin_width, bin_height) - 1) /
          ivec2(bin_width, bin_height);
  farthest_.assign(size_t(bins_.x * bins_.y), checked.before.empty() ? no_depth : -no_depth);
  if (!checked.before.empty())
    for (int y = 0; y < view.height; y++)
      for (int x = 0; x < view.width; x++) {
        float& most = farthest_[size_t(y / bin_height * bins_.x + x / bin_width)];
        most = std::max(most, checked.before[size_t(y) * size_t(view.width) + size_t(x)]);
      }
  find_seen(lawn, state, view, checked);
  const WindNow now(wind, state.time);
  parallel_ranges(int(seen_.size()), 4, [&](int begin, int end) {
    for (int i = begin; i < end; i++) project(lawn, state, now, view, checked, seen_[size_t(i)]);
  });
  put_in_bins();
  parallel_each(bins_.x * bins_.y, Filler{*this, view, checked, picture});
  counts.tiles = int(seen_.size());
  for (const Seen& seen : seen_) counts.blades += seen.count;
  return counts;
}

}  // namespace wellspring::lawn
