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
      things.scans.all(), [](const PlacedScan& placed) { return placed.points != nullptr; });
  if (!points) return VolumeView(things.volumes, view, true, 0).window();
  return {0, 0, view.width, view.height};
}

}  // namespace

LaidView::LaidView(const LaidThings& things, const View& view, vec2 offset, bool settled,
                   uint32_t turn, LaidWork& work)
    : view_(view),
      offset_(offset),
      volumes_(things.volumes, view, settled, turn),
      scans_(things.scans, view, offset, settled, work.scans) {}

Laid LaidView::look(int x, int y, const Lanes& surface) const {
  const SeenScan scan = scans_.any() ? scans_.look(x, y) : SeenScan{};
  const LaneMask near = scan.depth < surface;
  Laid laid;
  if (volumes_.shows(x, y, lane_count))
    laid = volumes_.look(x, y, offset_, near ? scan.depth : surface);
  const Lanes through = keep_lanes(near, laid.clear);
  laid.light = laid.light + scan.light * through;
  const LaneMask behind = near & (laid.depth > scan.depth);
  laid.depth = behind ? scan.depth : laid.depth;
  laid.object = behind ? scan.object : laid.object;
  laid.clear = keep_lanes(~near, laid.clear);
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
  if (view == view_ && looks == looks_ && scan_looks == scan_looks_ && arrivals == arrivals_ &&
      things.scans.maps == maps_)
    return false;
  view_ = view, looks_ = std::move(looks), scan_looks_ = std::move(scan_looks);
  arrivals_ = arrivals, maps_ = things.scans.maps, pictures_ = 0;
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
    for (; places > 0 && pictures_ < most_pictures; places--, pictures_++)
      add(LaidView(things, view, spread_in_pixel(int(pictures_)), true, pictures_, work), frame);
    lay_mean_over(frame);
  }
  splats_.lay_over(things.scans.all(), view, things.exposure, work.splats, frame);
}

size_t LaidLayer::memory_bytes() const {
  return bytes_of(color_, clear_, depth_, object_) + splats_.memory_bytes();
}

}  // namespace wellspring::picture
