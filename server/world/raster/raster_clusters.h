// SPDX-License-Identifier: Apache-2.0
// A mesh in handfuls of neighbouring triangles, each with its own copy of the corners: what a
// rasteriser culls, transforms and hands to a core at once.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "world/scene.h"

namespace wellspring::world {

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
  // Of each, as MeshNeighbours (world/raster/raster_walk.h) has them; left to who knows these.
  std::vector<float> width;
  std::vector<uint8_t> bar;
};
MeshClusters make_clusters(const Mesh& mesh);

}  // namespace wellspring::world
