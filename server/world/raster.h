// SPDX-License-Identifier: Apache-2.0
// What every pixel of a view sees first, found by a z-buffer: the hits that rays through the
// pixels' sampling places have, several times as fast as tracing these. Triangles are transformed
// and binned cluster by cluster, tiles drawn independently (tile-based rasterisation after Abrash,
// "Rasterization on Larrabee", 2009); edges are exact at 1/256 of a pixel, so that nothing shows
// through between neighbours and nothing is hit twice.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "world/bvh.h"
#include "world/view.h"

namespace wellspring {

// Up to 64 pixels of a row, from (x, y) to the right. Hits are those of the nearest surface that is
// not see-through; Hit::valid() false: there is none.
struct RasterRun {
  int x = 0, y = 0, count = 0;
  const Hit* hits = nullptr;        // barycentrics right to 1e-3, t to 1e-5 of itself
  const uint8_t* veiled = nullptr;  // 1: something see-through lies before that surface
};

struct RasterSettings {
  // Of each material of the scene (empty: none): its triangles hide nothing but veil what is
  // behind.
  std::span<const uint8_t> see_through;
  vec2 offset{0.5f};  // of the sampling place in its pixel, 0 to 1
};

// Keeps its arrays from picture to picture. Surfaces with alpha are passed through where a ray
// would (world/bvh.h). Surfaces nearer to the eye than a millionth of the scene's size are not
// seen.
class Raster {
 public:
  static constexpr int most_pixels = 8192;  // a side of the view
  // Borrows `world`. Cuts its meshes into clusters: a second or so for a million triangles.
  explicit Raster(const World& world);
  ~Raster();
  // Calls `take` from many threads, once for every run of the picture; together they cover every
  // pixel. Call after World::commit(), while nothing moves. A view larger than most_pixels gets no
  // runs.
  void draw(const View& view, const RasterSettings& settings,
            const std::function<void(const RasterRun&)>& take);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring
