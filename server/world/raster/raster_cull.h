// SPDX-License-Identifier: Apache-2.0
// Finds which clusters a picture has to draw: those in the visible cone, first the ones that likely
// hide others, then those that these do not hide (occlusion by two passes: Greene, Kass and Miller,
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

// Splits a mesh into handfuls of neighbouring triangles, each with its own copy of the corners: a
// rasteriser culls, transforms and hands them to a core at once.

struct Cluster {
  static constexpr int most_triangles = 128, most_corners = 248;  // so that they pad to 256
  uint32_t first_corner = 0, corners = 0;  // the first is a multiple of eight
  uint32_t first_triangle = 0, triangles = 0;
  Bounds box;      // mesh space
  vec3 centre{0};  // centre of a sphere around the cluster
  float radius = 0;
  float area = 0;  // sum over its triangles
};

// Holds a mesh's clusters, without triangles that have a corner that is not finite. Triangles of a
// cluster are of like size, so that its bounds are close and walls, which hide much, lie together.
struct MeshClusters {
  std::vector<Cluster> clusters;
  // Per corner, padded to eight by copies of the last: its place, and its vertex of the mesh.
  std::vector<float> x, y, z;
  std::vector<uint32_t> vertex;
  // Per triangle: its corners counted from the cluster's first, and its number in the mesh.
  std::vector<std::array<uint8_t, 3>> corner;
  std::vector<uint32_t> triangle;
  // Per triangle: width and bar as in MeshNeighbours (world/raster/raster_edges.h), filled in by
  // Raster.
  std::vector<float> width;
  std::vector<uint8_t> bar;
};
MeshClusters make_clusters(const Mesh& mesh);

// Names one cluster of one instance that may be in sight.
struct RasterPiece {
  uint32_t instance, cluster;
  float depth;   // depth of its nearest place
  float hiding;  // about how much of the picture its triangles may cover
};

// Returns where a moving mesh is now; empty for others.
Bounds moving_box(const PlacedMesh& placed);

// Appends the instance's clusters that the visible cone touches. `box`: moving_box().
void find_pieces(const View& view, const PlacedMesh& placed, const MeshClusters& mesh,
                 uint32_t instance, const Bounds& box, float near,
                 std::vector<RasterPiece>& pieces);

// Splits pieces into those to draw first and the rest; returns how many the first are; each part is
// sorted, the nearest first.
size_t put_hiding_first(std::vector<RasterPiece>& pieces);

// Returns whether all of the box is behind what the tiles hold. Their `least` must be up to date.
// `to_world`: null if the box is in world space.
bool is_hidden(const View& view, const RasterView& raster, const Bounds& box, const mat4* to_world,
               std::span<const TilePixels> tiles);

}  // namespace wellspring::world
