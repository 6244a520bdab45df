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
                      .shift = dvec3(placed.position)});
  return sets;
}

void draw(std::span<const PlacedScan> scans, const View& view, std::span<const float> surface,
          bool by_pixel, SplatDrawer& drawer, SplatPlanes& picture) {
  SplatDrawing settings;
  settings.by_pixel = by_pixel;
  settings.surface = surface;
  drawer.draw(picture, placed_splats(scans), camera_of(view), settings);
}

size_t bytes_of_picture(const SplatPlanes& picture) {
  return bytes_of(picture.light, picture.clear, picture.depth);
}

// Returns the object of the first set that is shown: a picture does not tell sets apart.
uint32_t object_of(std::span<const PlacedScan> scans) {
  for (const PlacedScan& placed : scans)
    if (is_shown(placed)) return placed.object;
  return 0;
}

}  // namespace

size_t SplatWork::memory_bytes() const { return bytes_of_picture(picture); }

bool has_splats(std::span<const PlacedScan> scans) { return std::ranges::any_of(scans, is_shown); }

void lay_splats_over(std::span<const PlacedScan> scans, const View& view, SplatWork& work,
                     Image8& image, std::vector<float>& depth) {
  SplatPlanes& splats = work.picture;
  draw(scans, view, depth, false, work.drawer, splats);
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

void SplatLayer::lay_over(std::span<const PlacedScan> scans, const View& view, float exposure,
                          SplatWork& work, Frame& frame) {
  if (!has_splats(scans)) return;
  std::vector<ScanLook> looks;
  for (const PlacedScan& placed : scans) looks.push_back(placed.look);
  if (!drawn_ || view != view_ || looks != looks_) {
    view_ = view, looks_ = std::move(looks), drawn_ = true;
    draw(scans, view, frame.depth, true, work.drawer, picture_);
  }
  wellspring::scan::lay_over(frame.color, picture_, exposure);
  const uint32_t object = object_of(scans);
  for (size_t i = 0; i < frame.depth.size(); i++) {
    if (!(picture_.depth[i] < frame.depth[i])) continue;
    frame.depth[i] = picture_.depth[i];
    frame.object[i] = object;
  }
}

size_t SplatLayer::memory_bytes() const { return bytes_of_picture(picture_); }

}  // namespace wellspring::picture
