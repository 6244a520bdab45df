// SPDX-License-Identifier: Apache-2.0
// What every pixel of a view sees, as planes: places and normals that light falls on (a G-buffer:
// Saito and Takahashi 1990).
#pragma once
#include "base/raw_vector.h"
#include "light/visible/visibility.h"

namespace wellspring::light {

// Row after row; arrays end with `surface_buffer_pad` more items that may be read.
inline constexpr int surface_buffer_pad = 16;
struct SurfaceBuffer {
  View view;
  RawVector<float> depth;       // along the viewing axis; infinity: nothing there
  RawVector<float> nx, ny, nz;  // normal, towards the eye, unit
  RawVector<uint32_t> object;   // 0: nothing there
  // Highlights, as light/visible/gloss.h packs them. Empty: nothing in the scene has any.
  RawVector<uint32_t> gloss;
  RawVector<uint8_t> metallic;
  size_t pixels() const { return size_t(view.width) * size_t(view.height); }
};
size_t memory_bytes(const SurfaceBuffer& surfaces);

// Overwrites `surfaces` by what `view` shows at the middle of its pixels, reusing memory. Normals
// are those of the mesh. Call as VisibilityPass::see().
void see_surfaces(const VisibilityPass& visibility, const View& view, SurfaceBuffer& surfaces,
                  RasterShows shows = RasterShows::all);

}  // namespace wellspring::light
