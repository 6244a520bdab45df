// SPDX-License-Identifier: Apache-2.0
#include "picture/volume_view.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/rng.h"
#include "picture/keyframe.h"

namespace wellspring::picture {
namespace {

constexpr Lanes lane{0, 1, 2, 3, 4, 5, 6, 7};
constexpr float moving_step = 1, settled_step = 0.5f;  // samples of the level
// Volumes that overlap are marched in turn through parts of at least so many steps.
constexpr int most_slabs = 32;
constexpr float slab_steps = 4;
constexpr float half_seen = 0.5f;  // share of the light behind that a volume keeps, to be there

constexpr float golden = 0.618034f;

Lanes whole_part_off(const Lanes& v) { return v - to_float(to_whole(v)); }  // v: 0 or more

// Returns numbers from 0 to 1 that differ as much as they can between neighbours (interleaved
// gradient noise: Jimenez 2014, "Next Generation Post Processing in Call of Duty").
Lanes spread_steps(int x, int y, uint32_t turn) {
  const Lanes along = whole_part_off(0.06711056f * (lane + float(x)) + 0.00583715f * float(y));
  return whole_part_off(whole_part_off(52.9829189f * along) + golden * float(turn % 1024));
}

bool overlap(const Bounds& a, const Bounds& b) {
  for (int i = 0; i < 3; i++)
    if (a.low[i] > b.high[i] || b.low[i] > a.high[i]) return false;
  return true;
}

// Returns where rays from the eye run through a box, metres; the end lies before the beginning
// where they do not.
void cross_box(const Bounds& box, vec3 eye, const Lanes3& way, Lanes& near, Lanes& far) {
  const Lanes* ways[3] = {&way.x, &way.y, &way.z};
  for (int i = 0; i < 3; i++) {
    const Lanes inverse = 1.0f / *ways[i];
    const Lanes a = (box.low[i] - eye[i]) * inverse, b = (box.high[i] - eye[i]) * inverse;
    const LaneMask crosses = *ways[i] != 0.0f;
    near = crosses ? lanes_max(near, lanes_min(a, b)) : near;
    far = crosses ? lanes_min(far, lanes_max(a, b)) : far;
    if (eye[i] < box.low[i] || eye[i] > box.high[i]) far = crosses ? far : all_lanes(-INFINITY);
  }
}

Lanes3 turned(const mat3& m, const Lanes3& v) {
  return {m[0].x * v.x + m[1].x * v.y + m[2].x * v.z, m[0].y * v.x + m[1].y * v.y + m[2].y * v.z,
          m[0].z * v.x + m[1].z * v.y + m[2].z * v.z};
}

}  // namespace

VolumeView::VolumeView(std::span<const PlacedVolume> volumes, const View& view, bool settled,
                       uint32_t turn)
    : view_(view), settled_(settled), turn_(turn) {
  for (const PlacedVolume& placed : volumes) {
    if (!placed.look.preset) continue;
    Seen seen{.placed = &placed, .to_volume = ToVolume(placed), .bounds = bounds_of(placed)};
    const Bounds& box = seen.bounds;
    seen.window = window_around(box, view);
    if (seen.window.empty()) continue;
    const vec3 nearest = glm::clamp(view.position, box.low, box.high);
    const float pixel = 2 * view.tan_half_fov / float(view.height);
    seen.level =
        level_for(placed.shown(), double(length(nearest - view.position) * pixel / placed.scale));
    seen_.push_back(seen);
  }
  auto distance = [&](const Seen& one) { return length(one.placed->position - view.position); };
  std::ranges::sort(seen_, {}, distance);
  for (size_t i = 0; i + 1 < seen_.size(); i++)
    seen_[i].joint = overlap(seen_[i].bounds, seen_[i + 1].bounds);
  int right = 0, bottom = 0;
  all_ = {view.width, view.height, 0, 0};
  for (const Seen& one : seen_) {
    all_.left = std::min(all_.left, one.window.left), all_.top = std::min(all_.top, one.window.top);
    right = std::max(right, one.window.left + one.window.width);
    bottom = std::max(bottom, one.window.top + one.window.height);
  }
  all_.width = right - all_.left, all_.height = bottom - all_.top;
}

bool VolumeView::shows(int x, int y, int count) const {
  return x < all_.left + all_.width && x + count > all_.left && y >= all_.top &&
         y < all_.top + all_.height;
}

float VolumeView::step_in_samples() const { return settled_ ? settled_step : moving_step; }

float VolumeView::step_of(const Seen& seen) const {
  const PlacedVolume& placed = *seen.placed;
  return std::ldexp(step_in_samples() * float(placed.shown().voxel), seen.level) * placed.scale;
}

MarchedLight VolumeView::march_one(const Seen& seen, const Rays& rays) const {
  const PlacedVolume& placed = *seen.placed;
  const VolumeLook& look = placed.look;
  VolumeRays inside;
  inside.origin = all_lanes(seen.to_volume.place(view_.position));
  inside.direction = turned(seen.to_volume.turn, rays.way);
  const float to_volume = 1 / placed.scale;
  inside.near = rays.near * to_volume, inside.far = rays.far * to_volume;
  MarchSettings settings;
  settings.level = seen.level;
  settings.step = step_in_samples();
  settings.jitter = rays.jitter;
  settings.cuts = look.cuts;
  MarchedLight found = march(placed.shown(), *look.preset, inside, settings);
  if (look.over) {
    const MarchedLight over = march(placed.shown(), *look.over, inside, settings);
    const Lanes own = all_lanes(1 - look.share), others = all_lanes(look.share);
    found.color = found.color * own + over.color * others;
    found.clear = found.clear * own + over.clear * others;
    if (look.share > 0.5f) found.depth = over.depth;
  }
  found.depth *= placed.scale;
  return found;
}

void VolumeView::add(const Seen& seen, const Rays& rays, Laid& laid) const {
  const MarchedLight found = march_one(seen, rays);
  laid.light = laid.light + found.color * laid.clear;
  const Lanes after = laid.clear * found.clear;
  const LaneMask half = (laid.clear >= half_seen) & (after < half_seen);
  laid.depth = half ? lanes_min(found.depth, rays.far) / rays.length : laid.depth;
  laid.object = half ? all_lane_bits(seen.placed->object) : laid.object;
  laid.clear = after;
}

void VolumeView::add_jointly(std::span<const Seen> group, const Rays& rays, Laid& laid) const {
  Lanes enter = all_lanes(INFINITY), leave{};
  float step = INFINITY;  // metres
  for (const Seen& seen : group) {
    step = std::min(step, step_of(seen));
    Lanes near = rays.near, far = rays.far;
    cross_box(seen.bounds, view_.position, rays.way, near, far);
    enter = near < far ? lanes_min(enter, near) : enter;
    leave = near < far ? lanes_max(leave, far) : leave;
  }
  const LaneMask crosses = enter < leave;
  if (!any_lane(crosses)) return;
  const Lanes way = keep_lanes(crosses, leave - enter);
  float longest = 0;
  for (int k = 0; k < lane_count; k++) longest = std::max(longest, way[k]);
  const int slabs = std::clamp(int(longest / (slab_steps * step)), 1, most_slabs);
  const Lanes part = way * (1 / float(slabs));
  for (int k = 0; k < slabs; k++) {
    Rays slab = rays;
    // Each part has steps of its own, so that what is too much in one is too little in another.
    slab.jitter = whole_part_off(rays.jitter + golden * float(k));
    slab.near = crosses ? enter + part * float(k) : all_lanes(INFINITY);
    slab.far = crosses ? enter + part * float(k + 1) : all_lanes(-INFINITY);
    for (const Seen& seen : group) add(seen, slab, laid);
  }
}

Laid VolumeView::look(int x, int y, vec2 offset, const Lanes& surface) const {
  const vec2 axis = axis_place(view_);
  const float pixel = 2 * view_.tan_half_fov / float(view_.height);
  const Lanes right = (lane + (float(x) + offset.x - axis.x)) * pixel;
  const float up = (axis.y - float(y) - offset.y) * pixel;
  const Lanes3 at = all_lanes(view_.right) * right + all_lanes(view_.up * up + view_.forward);
  Rays rays;
  rays.length = lanes_sqrt(dot(at, at));
  rays.way = at * (1.0f / rays.length);
  rays.near = view_.near * rays.length;
  rays.far = surface * rays.length;
  rays.jitter = spread_steps(x, y, turn_);
  Laid laid;
  for (size_t i = 0; i < seen_.size(); i++) {
    size_t last = i;
    while (seen_[last].joint) last++;
    if (last > i) {
      add_jointly(std::span(seen_).subspan(i, last + 1 - i), rays, laid);
      i = last;
      continue;
    }
    const PictureWindow& window = seen_[i].window;
    if (x < window.left + window.width && x + lane_count > window.left && y >= window.top &&
        y < window.top + window.height)
      add(seen_[i], rays, laid);
  }
  return laid;
}

}  // namespace wellspring::picture
