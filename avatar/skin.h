// SPDX-License-Identifier: Apache-2.0
// Moves the vertices: displacers, then linear blend skinning; normals follow. All cores, no allocation
// after the first call. Called once a tick.
#pragma once
#include <vector>

#include "avatar/pose.h"

namespace wellspring {

struct SkinScratch {
  std::vector<mat4> joints;
  std::vector<vec3> displaced;
};

// `placement` takes humanoid space to the world. Output vectors are resized to the character's vertices.
void skin(const Character& character, const Pose& pose, const mat4& placement, SkinScratch& scratch,
          std::vector<vec3>& positions, std::vector<vec3>& normals);

}  // namespace wellspring
