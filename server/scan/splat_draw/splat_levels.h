// SPDX-License-Identifier: Apache-2.0
// Puts splats into an octree whose inner nodes hold fewer splats that stand for those below: near
// ones are merged by their moments (after Kerbl et al. 2024, "A Hierarchical 3D Gaussian
// Representation", section 4.1). So what is far away is drawn with few.
#pragma once
#include <cstdint>
#include <vector>

#include "scan/splats/splat_set.h"

namespace wellspring::scan {

// Opacity ends there: a Gaussian of `e^(-q/2)` times the opacity is not drawn below one code of
// 255, so beyond this many standard deviations no splat is seen.
inline constexpr float splat_reach = 3.3290429f;

struct SplatNode {
  // Box around all of the splats at and below the node, to their reach; relative to the middle.
  vec3 low{0}, high{0};
  float cell = 0;      // edge of the cells whose splats are one here; 0: no splat is merged
  uint32_t first = 0;  // a leaf's place in SplatTree::order
  uint32_t count = 0;  // splats of the node itself
  uint32_t first_child = 0, child_count = 0;  // none: a leaf
};

struct SplatTree {
  vec3 middle{0};                // the set's places minus this are those of nodes
  std::vector<SplatNode> nodes;  // the root is first; children follow one another
  std::vector<uint32_t> order;   // numbers of splats of the set, leaf by leaf
  std::vector<SplatSet> merged;  // for each node; a leaf's is empty; places relative to the middle
};

// Leaves out splats that cannot be drawn: those with numbers that are not finite, and those that
// are clearer than one code of 255. Takes about a second for a million splats.
SplatTree make_splat_tree(const SplatSet& set);

// Merges splats in each cube of a grid into one; splats that are larger than a cell only with
// others that are, too. Mean and covariance are the mixture's; as much of a picture is covered.
// Splats that are alone stay as they are.
SplatSet merge_in_cells(const SplatSet& set, float cell);

}  // namespace wellspring::scan
