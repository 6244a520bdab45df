// SPDX-License-Identifier: Apache-2.0
// Which clusters a picture has to draw: those in the visible cone, first the ones that likely hide
// others, then what is not behind these (occlusion by two passes: Greene, Kass and Miller,
// "Hierarchical Z-Buffer Visibility", 1993).
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "world/raster/raster_tile.h"
#include "world/scene.h"
#include "world/view.h"

namespace wellspring::world {

// A mesh in handfuls of neighbouring triangles, each with its own copy of the corners: what a
// rasteriser culls, transforms and hands to a core at once.

struct Cluster {
  static constexpr int most_triangles = 128, most_corners = 248;  // so that they pad to 256
  uint32_t first_corner = 0, corners = 0;  // the first is a multiple of eight
  uint32_t first_triangle = 0, triangles = 0;
  Bounds box;      // mesh space
  vec3 centre{0};  // of a sphere around it
  float radius = 0;
  float area = 0;  // of all its triangles
};

// Triangles with a corner that is not finite are left out. Those of a cluster are of like size, so
// that its bounds are close and walls, which hide much, lie together.
struct MeshClusters {
  std::vector<Cluster> clusters;
  // Per corner, padded to eight by copies of the last: place and the vertex of the mesh it is.
  std::vector<float> x, y, z;
  std::vector<uint32_t> vertex;
  // Per triangle: its corners counted from the cluster's first, and its number in the mesh.
  std::vector<std::array<uint8_t, 3>> corner;
  std::vector<uint32_t> triangle;
  // Of each, as MeshNeighbours (world/raster/raster_edges.h) has them; left to who knows these.
  std::vector<float> width;
  std::vector<uint8_t> bar;
};
MeshClusters make_clusters(const Mesh& mesh);

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
