// SPDX-License-Identifier: Apache-2.0
// Finds what every pixel of a view sees first by a z-buffer: the same hits as rays through the
// pixels' sampling places, several times as fast as tracing these. Triangles are transformed and
// binned cluster by cluster, tiles drawn independently (tile-based rasterisation after Abrash,
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

// Holds what see-through surfaces do to the light from behind: light * tint + glow.
struct Veil {
  vec3 tint{1}, glow{0};
};

// A run holds up to `most` pixels of a row, from (x, y) to the right: for each the nearest surface
// that is not see-through, at its sampling place. Arrays may be read, not trusted, up to `most` +
// 8.
struct RasterRun {
  static constexpr int most = 64;
  static constexpr uint32_t nothing = 0xffffffffu;
  int x = 0, y = 0, count = 0;
  const float* depth = nullptr;  // along the viewing axis, right to 1e-5; infinity: nothing there
  const uint32_t* instance = nullptr;  // instance, or `nothing`
  const uint32_t* triangle = nullptr;
  const float *u = nullptr,
              *v = nullptr;    // barycentrics of the second and third corner, right to 1e-3
  const Veil* veil = nullptr;  // see-through surfaces before the pixel; null: none
  // The run is made of pieces that each show one triangle or nothing: piece k ends before
  // end[k], where the next begins.
  const uint8_t* end = nullptr;
  int pieces = 0;
};
// Returns pixel i of the run as the hit of a ray through its sampling place.
Hit hit_of(const RasterRun& run, int i, const View& view, vec2 offset);

// Says which of a scene's instances are drawn. See-through surfaces that stand still veil moving
// things, too.
enum class RasterShows : uint8_t { all, still, moving };

struct RasterSettings {
  vec2 offset{0.5f};  // sampling place in its pixel, 0 to 1
  // For each material of the scene (empty: none). Not 0: its triangles hide nothing but veil what
  // is behind; 1: alike all over, 2: differently at every pixel.
  std::span<const uint8_t> see_through;
  // Returns how a triangle veils: asked once a tile for each such triangle in sight, or once a
  // pixel, by many threads; `direction`: of a ray from the eye that meets it there. Needed if there
  // is such a triangle. Several before one place are put together in no order.
  std::function<Veil(const Hit& hit, vec3 direction)> veil;
  bool edges = false;   // find Raster::edges()
  PixelsDiffer differ;  // compares pixels that have been taken; asked by many threads
  RasterShows shows = RasterShows::all;
};

// Draws pictures, and keeps its arrays from one to the next. Rays pass through surfaces with alpha
// as in world/world.h, and so do pixels here; rays of the eye pass back faces, likewise. Surfaces
// nearer to the eye than View::near or a millionth of the scene's size are not seen.
class Raster {
 public:
  static constexpr int most_pixels = 8192;  // pixels of a side of the view
  // Borrows `world`, and cuts its meshes into clusters: a second or so for a million triangles.
  explicit Raster(const World& world);
  ~Raster();
  // Calls `take` from many threads, once for every run of the picture; together they cover every
  // pixel. Call after World::commit(), while nothing moves. A view larger than most_pixels gets no
  // runs.
  void draw(const View& view, const RasterSettings& settings,
            const std::function<void(const RasterRun&)>& take);
  // Returns pixels of the last picture that edges of objects and creases cut, if asked for. Each
  // pixel is named in one of the lists only, there maybe more than once.
  std::span<const std::vector<EdgeShare>> edges() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring::world
