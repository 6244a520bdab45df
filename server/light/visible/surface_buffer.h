// SPDX-License-Identifier: Apache-2.0
// Keeps what every pixel of a view sees, as planes: places and normals that light falls on (a
// G-buffer: Saito and Takahashi 1990).
#pragma once
#include <bit>
#include <cstdint>

#include "base/memory.h"
#include "light/visible/visibility.h"
#include "world/raster/raster.h"
#include "world/view.h"

namespace wellspring::light {

// Computes where a view's pixels lie, at a depth of 1.

// Holds vectors from the eye: the sampling place of pixel (x, y), `offset` into it, lies at
// view.position + depth * at(x, y).
struct PixelGrid {
  vec3 corner, right, down;
  explicit PixelGrid(const View& view, vec2 offset = vec2(0.5f)) {
    const float size = 2 * view.tan_half_fov / float(view.height);
    const vec2 axis = axis_place(view);
    right = view.right * size;
    down = view.up * -size;
    corner = view.forward + right * (offset.x - axis.x) + down * (offset.y - axis.y);
  }
  vec3 at(float x, float y) const { return corner + right * x + down * y; }
};

// Describes what is drawn of a run of pixels before light is put on it.

struct RunPixels {
  RunSurface surface;
  float glow_red[RasterRun::most], glow_green[RasterRun::most], glow_blue[RasterRun::most];
};

// Holds bits of a run's pixels: those that emit light, and among these the ones that do nothing
// else.
struct RunGlow {
  uint64_t some = 0, only = 0;
};

// Describes everything that is drawn of a run.
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

// Planes go row after row; arrays end with `surface_buffer_pad` more items that may be read.
inline constexpr int surface_buffer_pad = 16;
struct SurfaceBuffer {
  View view;
  RawVector<float> depth;       // along the viewing axis; infinity: nothing there
  RawVector<float> nx, ny, nz;  // normal, towards the eye, unit
  RawVector<uint32_t> object;   // 0: nothing there
  // Highlights, as light/visible/facet.h packs them. Empty: nothing in the scene has any.
  RawVector<uint32_t> gloss;
  RawVector<uint8_t> metallic;
  // Metres off the surface at which shadow rays begin at least. Empty: at none.
  RawVector<float> lift;
  size_t pixels() const { return size_t(view.width) * size_t(view.height); }
};
size_t memory_bytes(const SurfaceBuffer& surfaces);

// Overwrites `surfaces` by what `view` shows at the middle of its pixels, reusing memory. Normals
// are those of the mesh. Call it as VisibilityPass::see().
void see_surfaces(const VisibilityPass& visibility, const View& view, SurfaceBuffer& surfaces,
                  RasterShows shows = RasterShows::all);

}  // namespace wellspring::light
