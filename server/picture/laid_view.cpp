// SPDX-License-Identifier: Apache-2.0
#include "picture/laid_view.h"

#include <algorithm>
#include <cmath>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "picture/drawn_planes.h"
#include "picture/keyframe.h"

namespace wellspring::picture {
namespace {

constexpr uint32_t most_pictures = 64;  // whose mean is shown at rest

// Returns the part of the picture around all that may show something.
PictureWindow window_of(const LaidThings& things, const View& view) {
  const bool points = std::ranges::any_of(
      things.scans.all(), [](const PlacedScan& placed) { return !placed.sets.empty(); });
  if (!points)
    return joined(VolumeView(things.volumes, view, true, 0).window(),
                  lawn_window(things.lawns, view));
  return {0, 0, view.width, view.height};
}

}  // namespace

LaidView::LaidView(const LaidThings& things, const View& view, vec2 offset, bool settled,
                   uint32_t turn, LaidWork& work, std::span<const float> before,
                   const DynamicImage* dynamic)
    : view_(view),
      offset_(offset),
      volumes_(things.volumes, view, settled, turn),
      scans_(things.scans, view, offset, settled, work.scans, dynamic),
      grass_(things.lawns, {things.scans.world, things.scans.lights, dynamic}, view, offset, before,
             work.lawns) {}

namespace {

// Lays `cover` of something opaque, whose light is already times that, behind what is laid.
void add_behind(const LaneMask& which, const Lanes3& light, const Lanes& cover, const Lanes& depth,
                const LaneBits& object, Laid& laid) {
  laid.light = laid.light + light * keep_lanes(which, laid.clear);
  const LaneMask first = which & (cover >= 0.5f) & (laid.depth > depth);
  laid.depth = first ? depth : laid.depth;
  laid.object = first ? object : laid.object;
  laid.clear *= 1.0f - keep_lanes(which, cover);
}

}  // namespace

Laid LaidView::look(int x, int y, const Lanes& surface) const {
  const SeenScan scan = scans_.any() ? scans_.look(x, y) : SeenScan{};
  const LaneMask near = scan.depth < surface;
  const Lanes solid = near ? scan.depth : surface;
  const bool grows = grass_.shows(x, y, lane_count);
  const SeenLawn grass = grows ? grass_.look(x, y) : SeenLawn{};
  const LaneMask grown = grass.depth < solid;
  Laid laid;
  if (volumes_.shows(x, y, lane_count))
    laid = volumes_.look(x, y, offset_, grown & (grass.cover >= 0.5f) ? grass.depth : solid);
  if (grows) add_behind(grown, grass.light, grass.cover, grass.depth, grass.object, laid);
  add_behind(near, scan.light, all_lanes(1), scan.depth, scan.object, laid);
  return laid;
}

void LaidView::lay_over(int x, int y, Shown& shown) const {
  const Laid laid = look(x, y, shown.depth);
  shown.color.r = laid.light.x + laid.clear * shown.color.r;
  shown.color.g = laid.light.y + laid.clear * shown.color.g;
  shown.color.b = laid.light.z + laid.clear * shown.color.b;
  const LaneMask there = laid.depth < shown.depth;
  shown.depth = there ? laid.depth : shown.depth;
  shown.object = there ? laid.object : shown.object;
}

// Returns whether the mean of before is of no use.
bool LaidLayer::begins(const LaidThings& things, const View& view) {
  std::vector<VolumeLook> looks;
  std::vector<ScanLook> scan_looks;
  uint64_t arrivals = 0;
  for (const PlacedVolume& placed : things.volumes)
    looks.push_back(placed.look), arrivals += placed.shown().arrivals();
  for (const PlacedScan& placed : things.scans.all()) scan_looks.push_back(placed.look);
  std::vector<std::pair<std::shared_ptr<const LawnLight>, uint64_t>> lawns;
  for (const ShownLawn& shown : things.lawns) lawns.emplace_back(shown.light, shown.moment);
  const Bounds moving = things.moving();
  if (!has_moved(moving_, moving) && view == view_ && looks == looks_ &&
      scan_looks == scan_looks_ && arrivals == arrivals_ && things.scans.maps == maps_ &&
      lawns == lawns_)
    return false;
  view_ = view, looks_ = std::move(looks), scan_looks_ = std::move(scan_looks);
  moving_ = moving, arrivals_ = arrivals, maps_ = things.scans.maps;
  lawns_ = std::move(lawns), pictures_ = 0;
  return true;
}

// Adds one more picture to the sums.
void LaidLayer::add(const LaidView& laid, const Frame& frame) {
  parallel_each(window_.height, [&](int row) {
    const size_t to = size_t(row) * size_t(window_.width);
    const size_t from = size_t(window_.top + row) * size_t(view_.width) + size_t(window_.left);
    for (int x = 0; x < window_.width; x += lane_count) {
      const int count = std::min(lane_count, window_.width - x);
      Lanes surface{};
      for (int k = 0; k < count; k++) surface[k] = frame.depth[from + size_t(x + k)];
      const Laid one = laid.look(window_.left + x, window_.top + row, surface);
      for (int k = 0; k < count; k++) {
        const size_t i = to + size_t(x + k);
        color_[i] += one.light.at(k), clear_[i] += one.clear[k];
        depth_[i] = one.depth[k], object_[i] = one.object[k];
      }
    }
  });
}

void LaidLayer::lay_mean_over(Frame& frame) const {
  const float share = 1 / float(pictures_);
  parallel_each(window_.height, [&](int row) {
    const size_t to = size_t(row) * size_t(window_.width);
    const size_t from = size_t(window_.top + row) * size_t(view_.width) + size_t(window_.left);
    for (int x = 0; x < window_.width; x++) {
      const size_t i = to + size_t(x), at = from + size_t(x);
      frame.color[at] = share * (color_[i] + clear_[i] * frame.color[at]);
      if (!(depth_[i] < frame.depth[at])) continue;
      frame.depth[at] = depth_[i], frame.object[at] = object_[i];
    }
  });
}

void LaidLayer::lay_over(const LaidThings& things, const View& view, int places, LaidWork& work,
                         Frame& frame) {
  if (things.empty()) return;
  if (begins(things, view)) {
    window_ = window_of(things, view);
    const size_t pixels = window_.empty() ? 0 : size_t(window_.width) * size_t(window_.height);
    color_.assign(pixels, vec3(0)), clear_.assign(pixels, 0);
    depth_.assign(pixels, INFINITY), object_.assign(pixels, 0);
    splats_.forget();
  }
  if (!window_.empty()) {
    const std::span<const float> before =
        places > 1 ? std::span<const float>(frame.depth) : std::span<const float>();
    for (; places > 0 && pictures_ < most_pictures; places--, pictures_++)
      add(LaidView(things, view, spread_in_pixel(int(pictures_)), true, pictures_, work, before),
          frame);
    lay_mean_over(frame);
  }
  splats_.lay_over(things.scans, view, things.exposure, work.splats, frame);
}

size_t LaidLayer::memory_bytes() const {
  return bytes_of(color_, clear_, depth_, object_) + splats_.memory_bytes();
}

}  // namespace wellspring::picture
