// SPDX-License-Identifier: Apache-2.0
#include "picture/splat_view.h"

#include <algorithm>
#include <cmath>

#include "base/memory.h"
#include "base/parallel.h"
#include "frame/tonemap.h"
#include "picture/scan_view.h"

namespace wellspring::picture {
namespace {

bool is_shown(const PlacedScan& placed) { return placed.splats != nullptr; }

std::vector<PlacedSplats> placed_splats(std::span<const PlacedScan> scans) {
  std::vector<PlacedSplats> sets;
  for (const PlacedScan& placed : scans)
    if (is_shown(placed))
      sets.push_back({.splats = placed.splats.get(),
                      .turn = placed.turn,
                      .scale = double(placed.scale),
                      .shift = dvec3(placed.position),
                      .cuts = placed.look.cuts});
  return sets;
}

// Darkens what lies near what moves, as a floor does: splats have no normals.
void shade(const ShownScans& scans, const View& view, LitBlocks& blocks, SplatPlanes& picture) {
  const MovingShade shade(*scans.world);
  const PictureWindow window = shaded_window(shade, view);
  if (window.empty()) return;
  const vec3 up(0, 1, 0);
  auto depth_at = [&](int x, int y) {
    return picture.depth[size_t(y) * size_t(view.width) + size_t(x)];
  };
  // Blocks turn normals to the eye: from below it is the ceiling's.
  blocks.begin(view, vec2(0.5f), window);
  blocks.fill(
      depth_at, [&](int, int) { return up; },
      [&](vec3 place, LitBlock& lit) {
        if (!shade.reaches(place)) return false;
        lit.normal = up;
        lit.light = vec3(shade.eval_open(place, up, vec3(0)));
        return true;
      });
  parallel_each(window.height, [&](int row) {
    const int y = window.top + row;
    const size_t first = size_t(y) * size_t(view.width);
    for (int x = window.left; x < window.left + window.width; x += lane_count) {
      const int count = std::min(lane_count, view.width - x);
      Lanes depth = all_lanes(INFINITY);
      for (int k = 0; k < count; k++) depth[k] = picture.depth[first + size_t(x + k)];
      const LaneMask there = depth < INFINITY;
      if (!any_lane(there) || !blocks.reach(x, y)) continue;
      const Lanes3 left = blocks.at(x, y, depth, all_lanes(up), 1);
      for (int k = 0; k < count; k++)
        if (there[k]) picture.light[first + size_t(x + k)] *= left.x[k];
    }
  });
}

void draw(const ShownScans& scans, const View& view, std::span<const float> surface, bool by_pixel,
          SplatWork& work, SplatPlanes& picture) {
  SplatDrawing settings;
  settings.by_pixel = by_pixel;
  settings.surface = surface;
  work.drawer.draw(picture, placed_splats(scans.all()), camera_of(view), settings);
  shade(scans, view, work.blocks, picture);
}

size_t bytes_of_picture(const SplatPlanes& picture) {
  return bytes_of(picture.light, picture.clear, picture.depth);
}

}  // namespace

size_t SplatWork::memory_bytes() const {
  return drawer.memory_bytes() + bytes_of_picture(picture) + blocks.memory_bytes();
}

bool has_splats(std::span<const PlacedScan> scans) { return std::ranges::any_of(scans, is_shown); }

uint32_t splat_object(std::span<const PlacedScan> scans) {
  const auto first = std::ranges::find_if(scans, is_shown);
  return first == scans.end() ? 0 : first->object;
}

void lay_splats_over(const ShownScans& scans, const View& view, SplatWork& work, Image8& image,
                     std::vector<float>& depth) {
  SplatPlanes& splats = work.picture;
  draw(scans, view, depth, false, work, splats);
  parallel_each(view.height, [&](int y) {
    for (size_t i = size_t(y) * size_t(view.width), end = i + size_t(view.width); i < end; i++) {
      const float clear = splats.clear[i];
      if (clear == 1) continue;
      const vec3& light = splats.light[i];
      Lanes own{light.x, light.y, light.z};
      own = encode_srgb(lanes_min(own, all_lanes(1)));
      for (int c = 0; c < 3; c++) {
        uint8_t& code = image.rgb[3 * i + size_t(c)];
        code = uint8_t(std::clamp(255 * own[c] + clear * float(code) + 0.5f, 0.0f, 255.0f));
      }
      depth[i] = std::min(depth[i], splats.depth[i]);
    }
  });
}

void SplatLayer::lay_over(const ShownScans& scans, const View& view, float exposure,
                          SplatWork& work, Frame& frame) {
  if (!has_splats(scans.all())) return;
  std::vector<ScanLook> looks;
  for (const PlacedScan& placed : scans.all()) looks.push_back(placed.look);
  const Bounds moving = scans.moving();
  if (!drawn_ || view != view_ || looks != looks_ || has_moved(moving_, moving)) {
    view_ = view, looks_ = std::move(looks), moving_ = moving, drawn_ = true;
    draw(scans, view, frame.depth, true, work, picture_);
  }
  wellspring::scan::lay_over(frame.color, picture_, exposure);
  const uint32_t object = splat_object(scans.all());
  for (size_t i = 0; i < frame.depth.size(); i++) {
    if (!(picture_.depth[i] < frame.depth[i])) continue;
    frame.depth[i] = picture_.depth[i];
    frame.object[i] = object;
  }
}

size_t SplatLayer::memory_bytes() const { return bytes_of_picture(picture_); }

}  // namespace wellspring::picture
