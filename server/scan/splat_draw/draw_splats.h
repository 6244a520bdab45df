// SPDX-License-Identifier: Apache-2.0
// Makes pictures of Gaussian splats on the processor (Kerbl et al. 2023, "3D Gaussian Splatting for
// Real-Time Radiance Field Rendering", section 6): project, sort, list by tiles, blend. In motion
// splats are in the order of their middles; at rest in each pixel's own.
//
// Splats are trained so that their blend in display codes (sRGB) looks right. So they are blended
// so, and only what comes out is made linear: over black, a picture is the reference's, decoded.
// Over anything else lay_over() goes on blending in codes, so over a picture that is exposed it is
// the reference's over that picture. `light` + `clear` times what is behind would be too dark at
// half opaque edges.
#pragma once
#include <span>
#include <vector>

#include "scan/splat_draw/draw_blend.h"
#include "scan/camera.h"

namespace wellspring::scan {

struct SplatDrawing {
  bool by_pixel = false;  // at rest: exact, some five times slower
  ProjectSettings project;
  // Depths (metres along the axis) of opaque things in each pixel, infinity for none; splats behind
  // are hidden. Empty: nothing is in front of any splat. Borrowed for the call.
  std::span<const float> surface;
};

struct SplatPlanes {
  int width = 0, height = 0;
  std::vector<vec3> light;   // linear; 1 is a display's white
  std::vector<float> clear;  // share of the codes behind that comes through, 0 to 1
  // Metres along the axis at which half of what is behind is hidden; infinity: less is.
  std::vector<float> depth;
  int64_t looked_at = 0, drawn = 0;  // splats that were chosen, and that are in the picture
};

// Draws pictures, one after the other; keeps memory for the next one: about 90 bytes a splat that
// is looked at, and 60 a pixel. Uses all cores; the picture does not depend on how many.
class SplatDrawer {
 public:
  void draw(SplatPlanes& picture, std::span<const PlacedSplats> sets, const ScanCamera& view,
            const SplatDrawing& settings);
  size_t memory_bytes() const;

 private:
  void draw_in_order(const SplatGrid& grid);
  void draw_by_pixel(const SplatGrid& grid);
  SplatTilePlace place_of(const SplatGrid& grid, int tile) const;

  DrawnSplats drawn_;
  std::vector<DrawnKey> spare_;
  std::vector<PixelBox> boxes_;  // in the order of keys
  SplatLists lists_;
  std::vector<SplatTile> tiles_;
  // One over the depth of surfaces, as in SplatTile, if there are any; and for each tile the least
  // of them, infinity where no splat can be seen any more.
  std::vector<float> surface_, limits_;
};

// Lays splats over a linear picture of the same size, of which `exposure` times a value of 1 is a
// display's white.
void lay_over(std::span<vec3> linear, const SplatPlanes& picture, float exposure);

}  // namespace wellspring::scan
