// SPDX-License-Identifier: Apache-2.0
// What every pixel of a view sees, without the light that falls there, drawn instead of traced
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

// What light falls on at a run's pixels.
struct RunSurface {
  static constexpr int most = RasterRun::most + 8;  // vectors are stored whole
  float red[most], green[most], blue[most];         // reflectance, linear
  float nx[most], ny[most], nz[most];               // normal, towards the eye; not unit
};

// Light that a run's pixels reflect of what moves, and how: radiance is
// light * reflectance * (1 - gloss) + shine * gloss.
struct RunSkin {
  float red[RunSurface::most], green[RunSurface::most], blue[RunSurface::most];
  float gloss[RunSurface::most];  // albedo of the dielectric's reflection, 0 to 1
  float shine_red[RunSurface::most], shine_green[RunSurface::most], shine_blue[RunSurface::most];
};

// Of a run's pixels, Sample::known: what the light of points counts in multiples of.
struct RunKnown {
  float red[RunSurface::most], green[RunSurface::most], blue[RunSurface::most];
  // Pixels of which a map says all, a bit each: what they reflect is plain (is_plain()), and their
  // light has no edge that its nodes could not hold. Of those, as in RunSkin:
  uint64_t plain = 0;
  float gloss[RunSurface::most];
};

// Up to 64 pixels of a row, from (x, y) to the right. As light/visible/guides.h answers for
// rays through the pixels' sampling places, but that normals are those of the mesh, without normal
// maps, pictures are averaged over the pixel, and clear panes tint a part of the picture alike.
class VisibleRun {
 public:
  int x = 0, y = 0, count = 0;
  uint64_t picture = 0;  // a number that no other call of see() has
  // Arrays may be read, not trusted, up to RasterRun::most + 8.
  const float* depth = nullptr;      // along the viewing axis; infinity: nothing there
  const uint32_t* object = nullptr;  // 0: nothing there
  // Of the pixels whose bit is set, and maybe of others. Returns those of the set bits that emit
  // light, or of which see() knows more or only see() knows.
  uint64_t describe(uint64_t wanted, RunSurface& to) const;
  // Pixels that may see what is polished: their guides are those of what it shows
  // (light/visible/guides.h).
  uint64_t polished() const;
  // Highlights of its pixels (light/visible/facet.h); none where rays have seen them.
  void gloss(uint32_t* codes, uint8_t* metallic) const;
  // Of its pixels that show what moves, as `surface` describes it (light/known/skin_light.h); of
  // others anything. Returns those, a bit each; none where rays have seen them. Rough gloss shows
  // the light that is kept, as much as comes about from where it mirrors; smooth gloss what rays
  // meet there, and those of `lights` that have no size.
  uint64_t light(const struct SkinLight& skin, const Lights& lights, const RunSurface& surface,
                 RunSkin& to) const;
  // Of its pixels whose diffuse light the map knows (light/sample/illumination_map.h); of others
  // anything. Returns those, a bit each; none where rays have seen them. `surface`: as described.
  uint64_t known(const struct IlluminationMap& map, const RunSurface& surface, RunKnown& to) const;
  // Everything of pixel i; costs as much as a dozen descriptions.
  PrimaryHit see(int i) const;

 private:
  friend class VisibilityPass;
  struct Impl;
  const Impl* impl_ = nullptr;
  const PrimaryHit* seen_ = nullptr;  // by rays: of each pixel, instead
};

class VisibilityPass {
 public:
  // Borrows `world`; keeps what it needs of `lights`. A second or so for a scene of many pictures.
  VisibilityPass(const World& world, const Lights& lights);
  ~VisibilityPass();

  // Calls `take` from many threads; together the calls cover every pixel once. `offset`: of the
  // sampling place in its pixel, 0 to 1. `blur`: pixels over which pictures on surfaces are
  // averaged. Call after World::commit(), while nothing moves.
  void see(const View& view, vec2 offset, const std::function<void(const VisibleRun&)>& take,
           RasterShows shows = RasterShows::all, float blur = 1) const;
  // The same, and then finds Raster::edges(), which are good until the next call. `differ`: as
  // RasterSettings has it.
  std::span<const std::vector<EdgeShare>> see_edges(
      const View& view, vec2 offset, const std::function<void(const VisibleRun&)>& take,
      RasterShows shows = RasterShows::all, PixelsDiffer differ = {}) const;
  // Has anything highlights?
  bool any_gloss() const;
  // Is it of a mesh that moves?
  bool moves(uint32_t object) const;
  // Is there a visible one that does, wherever it is?
  bool anything_moves() const;
  // Around all that moves and is visible, in scene coordinates; empty: low above high.
  Bounds moving_bounds() const;
  // Is the view rasterised? Otherwise rays are cast: no edges are found, and what moves counts as
  // still.
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
