// SPDX-License-Identifier: Apache-2.0
#include "light/visible/surface_buffer.h"

#include <cmath>
#include <cstring>

#include "base/memory.h"

namespace wellspring::light {

size_t memory_bytes(const SurfaceBuffer& surfaces) {
  return bytes_of(surfaces.depth, surfaces.nx, surfaces.ny, surfaces.nz, surfaces.object,
                  surfaces.gloss, surfaces.metallic, surfaces.lift);
}

void see_surfaces(const VisibilityPass& visibility, const View& view, SurfaceBuffer& surfaces,
                  RasterShows shows) {
  surfaces.view = view;
  const size_t pixels = surfaces.pixels() + surface_buffer_pad;
  for (auto* plane : {&surfaces.depth, &surfaces.nx, &surfaces.ny, &surfaces.nz})
    plane->resize(pixels);
  surfaces.object.resize(pixels);
  surfaces.lift.clear();
  const bool gloss = visibility.any_gloss();
  surfaces.gloss.resize(gloss ? pixels : 0), surfaces.metallic.resize(gloss ? pixels : 0);
  auto take = [&](const VisibleRun& run) {
    RunPixels p;
    describe_run(run, p);
    const RunSurface& seen = p.surface;
    const size_t at = size_t(run.y) * size_t(view.width) + size_t(run.x);
    std::memcpy(&surfaces.depth[at], run.depth, size_t(run.count) * sizeof(float));
    std::memcpy(&surfaces.object[at], run.object, size_t(run.count) * sizeof(uint32_t));
    if (gloss) run.gloss(&surfaces.gloss[at], &surfaces.metallic[at]);
    for (int i = 0; i < run.count; i++) {
      const float x = seen.nx[i], y = seen.ny[i], z = seen.nz[i];
      const float length2 = x * x + y * y + z * z;
      const float inverse = length2 > 0 ? 1 / std::sqrt(length2) : 0.0f;
      surfaces.nx[at + size_t(i)] = x * inverse;
      surfaces.ny[at + size_t(i)] = y * inverse;
      surfaces.nz[at + size_t(i)] = z * inverse;
    }
  };
  visibility.see(view, vec2(0.5f), take, shows);
}

}  // namespace wellspring::light
