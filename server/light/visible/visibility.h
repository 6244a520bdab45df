// SPDX-License-Identifier: Apache-2.0
// Draws what every pixel of a view sees, without the light that falls there, instead of tracing it
// (world/raster/raster.h): shape and reflectance of a whole picture for the price of a few thousand
// samples. Within a solid of glass, whose own light and colour only rays meet, rays are cast.
#pragma once
#include <functional>
#include <memory>
#include <span>

#include "light/visible/guides.h"
#include "world/raster/raster.h"

namespace wellspring::light {

class VisibilityPass;

// Holds the surface that light falls on at a run's pixels.
struct RunSurface {
  static constexpr int most = RasterRun::most + 8;  // vectors are stored whole
  float red[most], green[most], blue[most];         // reflectance, linear
  float nx[most], ny[most], nz[most];               // normal, towards the eye; not unit
};

// Holds the kept light that a run's pixels on moving things reflect, and how: radiance is light *
// reflectance * (1 - gloss) + shine * gloss.
struct RunSkin {
  float red[RunSurface::most], green[RunSurface::most], blue[RunSurface::most];
  float gloss[RunSurface::most];  // albedo of the dielectric's reflection, 0 to 1
  float shine_red[RunSurface::most], shine_green[RunSurface::most], shine_blue[RunSurface::most];
};

// Holds Sample::known of a run's pixels: the light of points counts in multiples of it.
struct RunKnown {
  float red[RunSurface::most], green[RunSurface::most], blue[RunSurface::most];
  // Pixels for which a map gives all light, a bit each: what they reflect is plain (is_plain()),
  // and their light has no edge that its nodes could not hold. For these, as in RunSkin:
  uint64_t plain = 0;
  float gloss[RunSurface::most];
};

// Holds up to 64 pixels of a row, from (x, y) to the right. It answers as
// light/visible/guides.h does for rays through the pixels' sampling places, but normals are
// those of the mesh, without normal maps, pictures are averaged over the pixel, and clear panes
// tint a part of the picture alike.
class VisibleRun {
 public:
  int x = 0, y = 0, count = 0;
  uint64_t picture = 0;  // unique to a call of see()
  // Arrays may be read up to RasterRun::most + 8; values beyond `count` mean nothing.
  const float* depth = nullptr;      // along the viewing axis; infinity: nothing there
  const uint32_t* object = nullptr;  // 0: nothing there
  // Describes the pixels whose bit is set, and maybe others. Returns those of the set bits that
  // emit light, or that only see() describes wholly.
  uint64_t describe(uint64_t wanted, RunSurface& to) const;
  // Returns pixels that may see polished surfaces: their guides are those of what it shows
  // (light/visible/guides.h).
  uint64_t polished() const;
  // Writes highlights of its pixels (light/visible/facet.h); none if rays have seen them.
  void gloss(uint32_t* codes, uint8_t* metallic) const;
  // Computes the light of its pixels that show what moves, as `surface` describes it
  // (light/kept/skin/skin_light.h); other pixels get any value. Returns the moving ones, a bit
  // each; none if rays have seen them. Rough gloss shows the light that is kept, as much as comes
  // about from where it mirrors; smooth gloss shows what rays meet there, and those of `lights`
  // that have no size.
  uint64_t light(const struct SkinLight& skin, const Lights& lights, const RunSurface& surface,
                 RunSkin& to) const;
  // Computes the light of its pixels whose diffuse light the map has
  // (light/sample/illumination_map.h); other pixels get any value. Returns the former, a bit each;
  // none if rays have seen them. `surface`: as described.
  uint64_t known(const struct IlluminationMap& map, const RunSurface& surface, RunKnown& to) const;
  // Returns everything of pixel i; costs as much as a dozen descriptions.
  PrimaryHit see(int i) const;

 private:
  friend class VisibilityPass;
  struct Impl;
  const Impl* impl_ = nullptr;
  const PrimaryHit* seen_ = nullptr;  // found by rays instead, one for each pixel
};

class VisibilityPass {
 public:
  // Borrows `world`; keeps what it needs of `lights`. Takes a second or so for a scene of many
  // pictures.
  VisibilityPass(const World& world, const Lights& lights);
  ~VisibilityPass();

  // Calls `take` from many threads; together the calls cover every pixel once. `offset`: sampling
  // place in its pixel, 0 to 1. `blur`: pixels over which pictures on surfaces are averaged. Call
  // it after World::commit(), while nothing moves.
  void see(const View& view, vec2 offset, const std::function<void(const VisibleRun&)>& take,
           RasterShows shows = RasterShows::all, float blur = 1) const;
  // Does the same, and then finds Raster::edges(), which are good until the next call. `differ`: as
  // RasterSettings has it.
  std::span<const std::vector<EdgeShare>> see_edges(
      const View& view, vec2 offset, const std::function<void(const VisibleRun&)>& take,
      RasterShows shows = RasterShows::all, PixelsDiffer differ = {}) const;
  // Returns whether anything has highlights.
  bool any_gloss() const;
  // Returns whether the object belongs to a mesh that moves.
  bool moves(uint32_t object) const;
  // Returns whether a visible object moves, wherever it is.
  bool anything_moves() const;
  // Returns the bounds of all that moves and is visible, in scene coordinates; empty: low above
  // high.
  Bounds moving_bounds() const;
  // Returns whether the view is rasterised. Otherwise rays are cast: no edges are found, and what
  // moves counts as still.
  bool rasterises(const View& view) const;

 private:
  friend class VisibleRun;
  bool draw(const View& view, RasterSettings settings, float blur,
            const std::function<void(const VisibleRun&)>& take) const;
  void cast(const View& view, vec2 offset, uint64_t picture,
            const std::function<void(const VisibleRun&)>& take) const;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace wellspring::light
