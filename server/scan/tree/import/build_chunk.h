// SPDX-License-Identifier: Apache-2.0
// The third stage of an import: the points of a chunk become a part of the tree, in memory, on one
// core (Schuetz et al. 2020, section 4.2).
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "base/vec.h"
#include "scan/tree/import/chunks.h"
#include "scan/tree/import/neighbours.h"
#include "scan/tree/opacity.h"
#include "scan/tree/import/voxel_means.h"

namespace wellspring::scan {

// Opacities come of 512 lines each: their standard error is 0.01 at 0.95, at most 0.022. If
// fewer than 0.7 of the first 64 are stopped, these are all, and it is 0.063 at most.
inline constexpr int opacity_lines = 512;
inline constexpr float opacity_least = 0.7f;

struct BuildSettings {
  TreeCube cube;
  bool has_classes = false;
  uint32_t leaf_points = 0;
  std::vector<vec3> stations;  // metres from the root's corner, by the points' numbers
};

// A node that has no place in a table yet. Its offset counts from the begin of the part's bytes.
struct BuiltNode {
  NodeRecord record{};
  std::array<uint32_t, 8> children{};  // numbers of nodes in the part, by octants
  NodeCube cube() const { return {record.level, {record.cell[0], record.cell[1], record.cell[2]}}; }
};

// A part of the tree below one node, the last one.
struct BuiltPart {
  std::vector<BuiltNode> nodes;
  std::vector<uint8_t> bytes;
  std::vector<VoxelSum> sums;  // the last node's, unless it is a leaf
};

// Makes nodes, one after the other.
class NodeMaker {
 public:
  explicit NodeMaker(const BuildSettings& settings) : settings_(settings) {}
  // Makes a leaf of points that lie in this cube, and appends it to `part`.
  void add_leaf(BuiltPart& part, const NodeCube& cube, const ChunkPoint* points, size_t count);
  // Makes an inner node of its children's sums, which `node` names.
  void add_inner(BuiltPart& part, BuiltNode node, std::span<const VoxelSum> sums);
  const NodeColumnData& columns() const { return columns_; }  // the last node's
  VoxelGatherer& gatherer() { return gatherer_; }

 private:
  void add(BuiltPart& part, BuiltNode node, float spacing_in_steps);
  void set_own_spacing(size_t point, float distance, float spacing);
  vec3 outward(vec3 normal, const ChunkPoint& point, vec3 place) const;

  const BuildSettings& settings_;
  Neighbours neighbours_;
  VoxelGatherer gatherer_;
  NodeColumnData columns_, given_;
  std::vector<vec3> normals_;
  std::vector<float> own_;
  std::vector<Sphere> spheres_;
};

// Points lose their order. `spare` has as much room as `points`.
BuiltPart build_chunk(const BuildSettings& settings, const Chunk& chunk,
                      std::vector<ChunkPoint>& points, std::vector<ChunkPoint>& spare);

// Returns the smallest cube of the tree that holds both.
NodeCube common_cube(const NodeCube& a, const NodeCube& b);
inline double edge_of(const TreeCube& tree, uint32_t level) {
  return std::ldexp(tree.edge, -int(level));
}
inline uint32_t octant_of(const NodeCube& parent, const NodeCube& child) {
  const uint32_t shift = child.level - parent.level - 1;
  return (child.cell.x >> shift & 1) | (child.cell.y >> shift & 1) << 1 |
         (child.cell.z >> shift & 1) << 2;
}

}  // namespace wellspring::scan
