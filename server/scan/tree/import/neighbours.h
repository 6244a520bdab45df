// SPDX-License-Identifier: Apache-2.0
// Looks at the neighbours of a node's points: the normal of the surface, and how far points are
// from each other.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "base/vec.h"

namespace wellspring::scan {

inline constexpr int neighbour_count = 10;
// The distance to this nearest neighbour is taken for the spacing: of points on a surface it is
// 1 / sqrt(density), be they on a grid or at random (1.09 of it). The nearest one itself is half as
// far when they are at random, and at no distance when they are there twice.
inline constexpr int spacing_neighbour = 4;

struct NodePlaces {
  std::span<const uint16_t> x, y, z;
  size_t size() const { return x.size(); }
};

// Finds neighbours by a grid of cells over a node's cube. Keeps its memory for the next node.
class Neighbours {
 public:
  // Sorts the points by cells; order()[i] is the number of the i-th one then.
  void sort(const NodePlaces& places);
  const std::vector<uint32_t>& order() const { return order_; }
  // Returns the mean distance to the fourth neighbour, in steps of the node's places; 0: there are
  // no two places. Each point's is `own`, 0 if its neighbours lie as on no surface; i is the place
  // in order(). Computes normals, unless null, from the plane through a point's ten nearest
  // neighbours (its covariance's least eigenvector); the sign is anyone's; 0: the neighbours lie on
  // a line. Neighbours are looked for in the 27 cells around, or in 125 if there are too few; of
  // more than 768 points a part is looked at.
  float look(std::vector<float>& own, std::vector<vec3>* normals);

 private:
  void gather(int x, int y, int z, int ring);
  template <int wanted>
  int find_nearest(vec3 place, float within, vec3* nearest, float* distances) const;

  int side_ = 1;
  std::vector<uint32_t> order_, starts_, cells_;
  std::vector<float> x_, y_, z_;  // sorted
  std::vector<float> near_x_, near_y_, near_z_;
  size_t near_ = 0;
};

}  // namespace wellspring::scan
