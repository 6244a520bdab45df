// SPDX-License-Identifier: Apache-2.0
// Which clusters a picture has to draw: those in the visible cone, first the ones that likely hide
// others, then what is not behind these (occlusion by two passes: Greene, Kass and Miller,
// "Hierarchical Z-Buffer Visibility", 1993).
#pragma once
#include <span>
#include <vector>

#include "world/raster/raster_clusters.h"
#include "world/raster/raster_tile.h"
#include "world/view.h"

namespace wellspring::world {

// One cluster of one instance that may be in sight.
struct RasterPiece {
  uint32_t instance, cluster;
  float depth;   // of its nearest place
  float hiding;  // how much of the picture its triangles may cover, about
};

// Of what moves: where it is now. Empty for all else.
Bounds moving_box(const PlacedMesh& placed);

// Appends the instance's clusters that the visible cone touches. `box`: moving_box().
void find_pieces(const View& view, const PlacedMesh& placed, const MeshClusters& mesh,
                 uint32_t instance, const Bounds& box, float near,
                 std::vector<RasterPiece>& pieces);

// Splits pieces into those to draw first and, returned, how many these are; each part is sorted,
// the nearest first.
size_t put_hiding_first(std::vector<RasterPiece>& pieces);

// Is all of the box behind what the tiles hold? Their `least` must be up to date. `to_world`: null
// where the box is in world space.
bool is_hidden(const View& view, const RasterView& raster, const Bounds& box, const mat4* to_world,
               std::span<const TilePixels> tiles);

}  // namespace wellspring::world
