// SPDX-License-Identifier: Apache-2.0
// Where every node stands at one moment: the node tree (glTF 2.0 section 3.5), animations (3.11,
// appendix C) and morph weights, in double precision.
#pragma once
#include "base/vec.h"
#include "gltf/file.h"

namespace wellspring::gltf {

struct Node {
  int parent = -1;
  dvec3 translation{0}, scale{1};
  glm::dquat rotation{1, 0, 0, 0};
  bool has_matrix = false;
  dmat4 matrix{1};
  dmat4 global{1};              // parent.global * local
  std::vector<double> weights;  // morph weights of the node's mesh
  bool shown = false;           // part of the scene that is shown
};

// All nodes of the file at `time` of its first animation; at 0 the rest pose. Throws LoadError for
// nodes with two parents, cycles, and animations that cannot be read.
std::vector<Node> make_pose(File& file, double time);

}  // namespace wellspring::gltf
