// SPDX-License-Identifier: Apache-2.0
// A node of a glTF file's tree (glTF 2.0 section 3.5) as it stands at one moment.
#pragma once
#include <vector>

#include "base/vec.h"

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

}  // namespace wellspring::gltf
