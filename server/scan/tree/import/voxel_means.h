// SPDX-License-Identifier: Apache-2.0
// Means of all points in the voxels of an inner node, which are what a picture shows of it.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "scan/tree/tree_format.h"

namespace wellspring::scan {

// Sums over all points in a voxel, so that sums of larger voxels follow exactly.
struct VoxelSum {
  uint32_t key = 0;     // x | y << 7 | z << 14 of the voxel in its node
  uint32_t weight = 0;  // points
  vec3 place{0};        // in voxels' edges, from the voxel's lowest corner
  vec3 color{0};        // linear
  // Normals that point against the sum so far are turned around: a wall seen from both sides, or
  // one whose sign is noise, has a normal all the same.
  vec3 normal{0};
  float intensity = 0;
  uint32_t classification = 0, votes = 0;  // a majority's class, if there is one
};

// Holds a node's columns while it is made.
struct NodeColumnData {
  std::vector<uint16_t> x, y, z, normal;
  std::vector<uint32_t> color;
  std::vector<uint8_t> classification, own_spacing;
  void resize(size_t count);
  size_t size() const { return x.size(); }
};

// Says where a node lies in the tree.
struct NodeCube {
  uint32_t level = 0;
  glm::uvec3 cell{0};
};

// Adds children to their parent's sums, child by child. Keeps 1 MiB of memory for the next node.
class VoxelGatherer {
 public:
  // Adds a leaf by its points, and an inner node by its sums.
  void add_points(std::vector<VoxelSum>& sums, const NodeCube& parent, const NodeCube& child,
                  const NodeColumnData& points);
  void add_sums(std::vector<VoxelSum>& sums, const NodeCube& parent, const NodeCube& child,
                std::span<const VoxelSum> of_child);

 private:
  VoxelSum& find(std::vector<VoxelSum>& sums, glm::uvec3 voxel);
  void forget(const std::vector<VoxelSum>& sums, size_t from);
  std::vector<uint32_t> numbers_;  // the places in sums of one octant's voxels
};

// Makes an inner node's columns of its voxels.
void make_means(NodeColumnData& means, std::span<const VoxelSum> sums);

}  // namespace wellspring::scan
