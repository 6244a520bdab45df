// SPDX-License-Identifier: Apache-2.0
// A kd-tree over a set of opaque spheres that tells dense cells from empty space, and which of its
// cells lie behind dense ones (paper on large particle sets, section 4). Two slips of the paper are
// mended: a cell's density is the share of lines that hit a sphere, and lines are those of
// opacity.h, which it leaves open.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"
#include "scan/tree/opacity.h"

namespace wellspring::scan {

struct ParticleNode {
  Box box;
  Box reach;                            // bounds its spheres, which may lie across the box's sides
  uint32_t first = 0, count = 0;        // spheres whose centres lie in it, in order()
  uint32_t child = 0;                   // the lower one, the other follows; 0: a leaf
  float opacity = 0, most_opacity = 0;  // its own; the largest of it and of all below
};

struct ParticleSettings {
  int depth = 15;
  int lines = 1000;           // a cell's opacity is known to 0.5 / sqrt(lines) or better
  float least_gap = 0.0625f;  // free space is split off if it is that share of a cell's extent
};

// A leaf is visible or occluded, a node may be both in part.
enum class ParticleState : uint8_t { visible, partial, occluded };

class ParticleTree {
 public:
  explicit ParticleTree(std::span<const Sphere> spheres, const ParticleSettings& settings = {});
  const std::vector<ParticleNode>& nodes() const { return nodes_; }  // the root is the first
  const std::vector<uint32_t>& order() const { return order_; }      // numbers of spheres
  // Returns the state of each node, seen from `eye`: the first nodes from the root that are as
  // opaque as the threshold hide what lies wholly behind them, and parts of themselves. At 1 only
  // those hide that no line of many passed.
  std::vector<ParticleState> cull(const dvec3& eye, float threshold) const;

 private:
  struct Split;
  class Culler;
  Split void_split(const Box& box, uint32_t first, uint32_t count, int axis) const;
  Split find_split(const Box& box, uint32_t first, uint32_t count, int axis, int depth);
  void find_reach(ParticleNode& node) const;
  uint32_t divide(const Split& split, uint32_t first, uint32_t count);
  void build(uint32_t number, int axis, int depth);

  const std::span<const Sphere> spheres_;
  const ParticleSettings settings_;
  std::vector<ParticleNode> nodes_;
  std::vector<uint32_t> order_;
};

}  // namespace wellspring::scan
