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
#include <vector>

#include "world/raster/raster_tile.h"
#include "world/view.h"
#include "world/world.h"

namespace wellspring::world {

// What see-through surfaces do to the light from behind: light * tint + glow.
struct Veil {
  vec3 tint{1}, glow{0};
};

// Up to `most` pixels of a row, from (x, y) to the right: of each the nearest surface that is not
// see-through, at its sampling place. Arrays may be read, not trusted, up to `most` + 8.
struct RasterRun {
  static constexpr int most = 64;
  static constexpr uint32_t nothing = 0xffffffffu;
  int x = 0, y = 0, count = 0;
  const float* depth = nullptr;  // along the viewing axis, right to 1e-5; infinity: nothing there
  const uint32_t* instance = nullptr;  // or nothing
  const uint32_t* triangle = nullptr;
  const float *u = nullptr,
              *v = nullptr;    // barycentrics of its second and third corner, right to 1e-3
  const Veil* veil = nullptr;  // of the see-through surfaces before it; null: there are none
  // The run is made of pieces that each show one triangle or nothing: piece k ends before
  // end[k], where the next begins.
  const uint8_t* end = nullptr;
  int pieces = 0;
};
// Pixel i of the run as a ray through its sampling place would have met it.
Hit hit_of(const RasterRun& run, int i, const View& view, vec2 offset);

// Of a scene's instances, those to be drawn. What is see-through and still veils what moves too.
enum class RasterShows : uint8_t { all, still, moving };

struct RasterSettings {
  vec2 offset{0.5f};  // of the sampling place in its pixel, 0 to 1
  // Of each material of the scene (empty: none). Not 0: its triangles hide nothing but veil what is
  // behind; 1: alike all over, 2: differently at every pixel.
  std::span<const uint8_t> see_through;
  // How: asked once a tile for each such triangle in sight, or once a pixel, by many threads;
  // direction: of a ray from the eye that meets it there. Needed where there is one. Several before
  // one place are put together in no order.
  std::function<Veil(const Hit& hit, vec3 direction)> veil;
  bool edges = false;   // find Raster::edges()
  PixelsDiffer differ;  // of pixels that have been taken; asked by many threads
  RasterShows shows = RasterShows::all;
};

// Keeps its arrays from picture to picture. Surfaces with alpha are passed through where a ray
// would (world/world.h), as back faces are where a ray of the eye does. Surfaces nearer to the eye
// than View::near or a millionth of the scene's size are not seen.
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
  // Of the last picture, if asked for: pixels that edges of objects and creases cut. Each pixel is
  // named in one of the lists only, there maybe more than once.
  std::span<const std::vector<EdgeShare>> edges() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring::world
