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

// Whether a node's global transform turns the winding round, so that clockwise triangles face the
// viewer (section 3.7.4). It decides for skinned meshes, too, although the node does not move them.
inline bool is_mirrored(const dmat4& global) { return glm::determinant(glm::dmat3(global)) < 0; }

}  // namespace wellspring::gltf
