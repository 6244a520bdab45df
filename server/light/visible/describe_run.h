// SPDX-License-Identifier: Apache-2.0
// What is drawn of a run of pixels before light is put on it.
#pragma once
#include <bit>
#include <cstdint>

#include "light/visible/visibility.h"
#include "world/raster/raster.h"

namespace wellspring::light {

struct RunPixels {
  RunSurface surface;
  float glow_red[RasterRun::most], glow_green[RasterRun::most], glow_blue[RasterRun::most];
};

// A run's pixels, a bit each: those that emit light by themselves, and of these the ones that do
// nothing else.
struct RunGlow {
  uint64_t some = 0, only = 0;
};

// Everything that is drawn of a run.
inline RunGlow describe_run(const VisibleRun& run, RunPixels& p) {
  uint64_t all = run.count < 64 ? (uint64_t(1) << run.count) - 1 : ~uint64_t(0);
  uint64_t alone = run.describe(all, p.surface);
  RunGlow emitting;
  for (; alone != 0; alone &= alone - 1) {
    int i = std::countr_zero(alone);
    PrimaryHit seen = run.see(i);
    p.surface.red[i] = seen.albedo.x, p.surface.green[i] = seen.albedo.y;
    p.surface.blue[i] = seen.albedo.z;
    p.surface.nx[i] = seen.normal.x, p.surface.ny[i] = seen.normal.y;
    p.surface.nz[i] = seen.normal.z;
    if (seen.scatters && seen.glow == vec3(0)) continue;
    emitting.some |= uint64_t(1) << i;
    if (!seen.scatters) emitting.only |= uint64_t(1) << i;
    p.glow_red[i] = seen.glow.x, p.glow_green[i] = seen.glow.y, p.glow_blue[i] = seen.glow.z;
  }
  return emitting;
}

}  // namespace wellspring::light
