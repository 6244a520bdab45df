// SPDX-License-Identifier: Apache-2.0
#include "light/virtual/backdrop_surfaces.h"

#include <algorithm>
#include <cmath>

#include "base/memory.h"
#include "light/virtual/direct_light.h"
#include "light/visible/surface_buffer.h"

namespace wellspring::light {
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

// Holds where the light of a run's pixels lies: four places each, or one.
struct RunTaps {
  static constexpr int most = RasterRun::most;
  int count, places;
  uint32_t at[4][most];
  float share[4][most];

  RunTaps(const BackdropSurfaces& backdrop, int x, int y, int run)
      : count(run), places(backdrop.shares.empty() ? 1 : 4) {
    const View& lit = backdrop.surfaces.view;
    if (places == 1) {
      for (int i = 0; i < count; i++) at[0][i] = uint32_t(y * lit.width + x + i), share[0][i] = 1;
      return;
    }
    const TapPair row = tap_pair(y, lit.height);
    const uint32_t above = uint32_t(row.first * lit.width),
                   below = uint32_t(row.second * lit.width);
    const uint32_t* shares = &backdrop.shares[size_t(y) * size_t(backdrop.view.width) + size_t(x)];
    for (int i = 0; i < count; i++) {
      const TapPair column = tap_pair(x + i, lit.width);
      const uint32_t first = uint32_t(column.first), second = uint32_t(column.second);
      at[0][i] = above + first, at[1][i] = above + second;
      at[2][i] = below + first, at[3][i] = below + second;
      for (int k = 0; k < 4; k++) share[k][i] = float(shares[i] >> (8 * k) & 255) * (1 / 255.0f);
    }
  }
  void read(const RawVector<float>& plane, float* to) const {
    for (int i = 0; i < count; i++) to[i] = plane[at[0][i]] * share[0][i];
    for (int k = 1; k < places; k++)
      for (int i = 0; i < count; i++) to[i] += plane[at[k][i]] * share[k][i];
  }
  bool any(const RawVector<uint32_t>& codes) const {
    uint32_t found = 0;
    for (int k = 0; k < places; k++)
      for (int i = 0; i < count; i++) found |= codes[at[k][i]];
    return found != 0;
  }
};

}  // namespace

void reflect_light(const BackdropSurfaces& backdrop, const LightPlanes& light, int x, int y,
                   int count, RunKnown& to) {
  const RunTaps taps(backdrop, x, y, count);
  const RawVector<float>* planes[] = {&light.red, &light.green, &light.blue};
  const RawVector<float>* gloss[] = {&light.gloss_red, &light.gloss_green, &light.gloss_blue};
  const RawVector<uint32_t>& codes = backdrop.surfaces.gloss;
  const bool glossy = !codes.empty() && taps.any(codes);
  const uint8_t* reflectance =
      &backdrop.reflectance[3 * (size_t(y) * size_t(backdrop.view.width) + size_t(x))];
  float* out[] = {to.red, to.green, to.blue};
  for (size_t c = 0; c < 3; c++) {
    taps.read(*planes[c], out[c]);
    for (int i = 0; i < count; i++) {
      const float root = float(reflectance[3 * size_t(i) + c]) * (1 / 255.0f);
      out[c][i] *= root * root;
    }
    if (!glossy) continue;
    float more[RunTaps::most];
    taps.read(*gloss[c], more);
    for (int i = 0; i < count; i++) out[c][i] += more[i];
  }
}

}  // namespace wellspring::light
