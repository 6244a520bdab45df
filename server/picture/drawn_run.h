// SPDX-License-Identifier: Apache-2.0
// What is drawn of a run of pixels before light is put on it (picture/compose_drawn.h).
#pragma once
#include <bit>
#include <cstdint>
#include <cstring>

#include "light/visible/visibility.h"
#include "picture/drawn_planes.h"
#include "world/raster/raster.h"

namespace wellspring {

struct RunPixels {
  RunSurface surface;
  float glow_red[RasterRun::most], glow_green[RasterRun::most], glow_blue[RasterRun::most];
};

// A run's pixels, a bit each: those that shine by themselves, and of these the ones that do nothing
// else.
struct Shining {
  uint64_t some = 0, only = 0;
};

// Everything that is drawn of a run.
inline Shining describe_run(const SightRun& run, RunPixels& p) {
  uint64_t all = run.count < 64 ? (uint64_t(1) << run.count) - 1 : ~uint64_t(0);
  uint64_t alone = run.describe(all, p.surface);
  Shining shining;
  for (; alone != 0; alone &= alone - 1) {
    int i = std::countr_zero(alone);
    Seen seen = run.see(i);
    p.surface.red[i] = seen.albedo.x, p.surface.green[i] = seen.albedo.y;
    p.surface.blue[i] = seen.albedo.z;
    p.surface.nx[i] = seen.normal.x, p.surface.ny[i] = seen.normal.y;
    p.surface.nz[i] = seen.normal.z;
    if (seen.scatters && seen.glow == vec3(0)) continue;
    shining.some |= uint64_t(1) << i;
    if (!seen.scatters) shining.only |= uint64_t(1) << i;
    p.glow_red[i] = seen.glow.x, p.glow_green[i] = seen.glow.y, p.glow_blue[i] = seen.glow.z;
  }
  return shining;
}

// Eight lanes of a run's array from lane `i` on, which may begin before it and end behind it.
inline Lanes lanes_at(const float* from, int i) {
  if (i >= 0) return load_lanes(from + i);  // arrays may be read up to eight beyond their end
  Lanes v{};
  std::memcpy(reinterpret_cast<float*>(&v) - i, from, size_t(lane_count + i) * sizeof(float));
  return v;
}

// What of a run moves, and its light.
struct RunMoving {
  uint64_t pixels = 0;  // a bit each
  RunSkin light;
};

// Eight of a run's bits, from lane `i` on, which may begin before it.
inline unsigned bits_at(uint64_t bits, int i) {
  return unsigned(i < 0 ? bits << -i : bits >> i) & 0xff;
}

inline constexpr float skin_samples = 64;  // as much as light of the skin is sure of

// Radiance of those of eight pixels, from lane `i` on, that reflect the light of the skin.
inline void put_moving(const RunPixels& p, const RunSkin& skin, int i,
                       const LaneMask& lanes_that_move, Shown& shown) {
  Lanes gloss = lanes_at(skin.gloss, i);
  auto put = [&](const float* light, const float* reflectance, Lanes& to) {
    Lanes lit = lanes_at(light, i) * (lanes_at(reflectance, i) * (1.0f - gloss) + gloss);
    to = lanes_that_move ? positive_lanes(lit) : to;
  };
  put(skin.red, p.surface.red, shown.color.r);
  put(skin.green, p.surface.green, shown.color.g);
  put(skin.blue, p.surface.blue, shown.color.b);
  shown.samples = lanes_that_move ? all_lanes(skin_samples) : shown.samples;
}

// What of eight pixels shines by itself. `here`: lanes that count, a bit each.
inline void add_glow(const RunPixels& p, const Shining& shining, int i, unsigned here,
                     Shown& shown) {
  const unsigned only = bits_at(shining.only, i);
  for (unsigned bits = bits_at(shining.some, i) & here; bits != 0; bits &= bits - 1) {
    int k = std::countr_zero(bits);
    Color& c = shown.color;
    if (only >> k & 1) c.r[k] = c.g[k] = c.b[k] = 0, shown.samples[k] = 255;
    c.r[k] += p.glow_red[i + k], c.g[k] += p.glow_green[i + k], c.b[k] += p.glow_blue[i + k];
  }
}

}  // namespace wellspring
