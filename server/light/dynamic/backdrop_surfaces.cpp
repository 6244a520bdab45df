// SPDX-License-Identifier: Apache-2.0
#include "light/dynamic/backdrop_surfaces.h"

#include <algorithm>
#include <cmath>

#include "base/memory.h"
#include "light/dynamic/light_taps.h"
#include "light/visible/describe_run.h"

namespace wellspring {
namespace {

uint8_t code_of(float reflectance) {
  return uint8_t(255 * std::sqrt(std::clamp(reflectance, 0.0f, 1.0f)) + 0.5f);
}

uint32_t shares_of(const TapWeights& weights) {
  uint32_t packed = 0;
  for (int k = 0; k < 4; k++) packed |= uint32_t(255 * weights.of[k] + 0.5f) << (8 * k);
  return packed;
}

}  // namespace

size_t memory_bytes(const BackdropSurfaces& backdrop) {
  return memory_bytes(backdrop.surfaces) + bytes_of(backdrop.reflectance, backdrop.shares);
}

void find_backdrop_surfaces(const VisibilityPass& visibility, const View& view,
                            BackdropSurfaces& backdrop) {
  backdrop.view = view;
  const size_t pixels = size_t(view.width) * size_t(view.height);
  const View lit = dynamic_light_view(view);
  see_surfaces(visibility, lit, backdrop.surfaces, RasterShows::still);
  backdrop.reflectance.resize(3 * pixels);
  const bool fine = lit == view;
  backdrop.shares.resize(fine ? 0 : pixels);
  const PixelGrid grid(lit), own(view);
  auto take = [&](const VisibleRun& run) {
    RunPixels p;
    const RunGlow emitting = describe_run(run, p);
    const TapPair row = tap_pair(run.y, lit.height);
    for (int i = 0; i < run.count; i++) {
      const size_t at = size_t(run.y) * size_t(view.width) + size_t(run.x + i);
      const bool reflects = run.object[i] != 0 && !(emitting.only >> i & 1);
      const RunSurface& s = p.surface;
      const float reflectance[] = {s.red[i], s.green[i], s.blue[i]};
      for (size_t c = 0; c < 3; c++)
        backdrop.reflectance[3 * at + c] = reflects ? code_of(reflectance[c]) : 0;
      if (!fine)
        backdrop.shares[at] = shares_of(weigh_taps(
            backdrop.surfaces, grid, tap_pair(run.x + i, lit.width), row,
            seen_point(run.depth[i], run.object[i], s, i, own.at(float(run.x + i), float(run.y)))));
    }
  };
  visibility.see(view, vec2(0.5f), take, RasterShows::still);
}

namespace {

// Light of a run of the picture, from its own resolution or between four pixels of half of it.
struct ArrivingRun {
  const BackdropSurfaces& backdrop;
  int x, y;
  TapPair row = tap_pair(y, backdrop.surfaces.view.height);
  size_t at = size_t(y) * size_t(backdrop.view.width) + size_t(x);

  float read(const float* plane, int i) const {
    if (backdrop.shares.empty()) return plane[at + size_t(i)];
    const int width = backdrop.surfaces.view.width;
    const float* above = plane + size_t(row.first) * size_t(width);
    const float* below = plane + size_t(row.second) * size_t(width);
    const TapPair column = tap_pair(x + i, width);
    const uint32_t shares = backdrop.shares[at + size_t(i)];
    return (above[column.first] * float(shares & 255) +
            above[column.second] * float(shares >> 8 & 255) +
            below[column.first] * float(shares >> 16 & 255) +
            below[column.second] * float(shares >> 24)) *
           (1 / 255.0f);
  }
  bool any_gloss(int count) const {
    const SurfaceBuffer& s = backdrop.surfaces;
    if (s.gloss.empty()) return false;
    const bool fine = backdrop.shares.empty();
    const int first = fine ? x : tap_pair(x, s.view.width).first;
    const int last = fine ? x + count - 1 : tap_pair(x + count - 1, s.view.width).second;
    uint32_t any = 0;
    for (int line : {fine ? y : row.first, fine ? y : row.second}) {
      const uint32_t* codes = &s.gloss[size_t(line) * size_t(s.view.width)];
      for (int i = first; i <= last; i++) any |= codes[i];
    }
    return any != 0;
  }
};

}  // namespace

void reflect_light(const BackdropSurfaces& backdrop, const LightPlanes& light, int x, int y,
                   int count, RunKnown& to) {
  const ArrivingRun run{backdrop, x, y};
  const RawVector<float>* planes[] = {&light.red, &light.green, &light.blue};
  const RawVector<float>* gloss[] = {&light.gloss_red, &light.gloss_green, &light.gloss_blue};
  const bool glossy = run.any_gloss(count);
  float* out[] = {to.red, to.green, to.blue};
  for (size_t c = 0; c < 3; c++) {
    const float* plane = planes[c]->data();
    const uint8_t* codes = &backdrop.reflectance[3 * run.at + c];
    for (int i = 0; i < count; i++) {
      const float root = float(codes[3 * i]) * (1 / 255.0f);
      out[c][i] = run.read(plane, i) * root * root;
    }
    if (!glossy) continue;
    for (int i = 0; i < count; i++) out[c][i] += run.read(gloss[c]->data(), i);
  }
}

}  // namespace wellspring
