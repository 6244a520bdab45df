// SPDX-License-Identifier: Apache-2.0
// Opacity by colour: a table over red, green and blue (paper sections 3.2 and 3.2.5), and the bound
// by which bricks that nobody would see are never decoded.
#pragma once
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "base/layers.h"
#include "volume/compressed/compressed_volume.h"

namespace wellspring::volume {

// Opacities at side^3 colours from 0 to 255, red fastest; each is what one voxel's length of that
// colour hides, 0 to 1.
class OpacityTable {
 public:
  // Asks `opacity` for each of the table's colours, display codes 0 to 255. Side: 2 to 256.
  OpacityTable(int side, const std::function<float(glm::vec3)>& opacity);
  int side() const { return side_; }
  float nearest(glm::vec3 color) const;
  float trilinear(glm::vec3 color) const;
  // Returns the table for voxels that are so many times as long: 1 - (1 - opacity)^times.
  OpacityTable stretched(float times) const;
  // Returns the greatest opacity, nearest or trilinear, of colours in a box of the colour cube.
  float greatest(glm::vec3 least, glm::vec3 most) const;

 private:
  OpacityTable() = default;
  void find_greatest();
  float at(int red, int green, int blue) const;
  struct Search;
  void search(Search& search, int level, glm::ivec3 cell) const;

  int side_ = 0;
  std::vector<float> opacities_;
  std::vector<std::vector<float>> greatest_;  // cells are 1, 2, 4, .. colours wide
  std::vector<int> sides_;
};

// Returns what no voxel of a brick exceeds, at any detail, and nothing between its voxels and their
// neighbours, whether their colours or their opacities are interpolated. The volume has colours.
// A brick may be skipped if this is below what can be seen.
float opacity_bound(const CompressedVolume& volume, const OpacityTable& table, glm::ivec3 brick);

}  // namespace wellspring::volume
