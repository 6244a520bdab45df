// SPDX-License-Identifier: Apache-2.0
// The smallest storyteller: one joint, and a flat plate at the height of 0.5 m.
#pragma once
#include "avatar/figure/character.h"

namespace wellspring::test {

inline Character make_tiny_figure() {
  Character character;
  character.joints.resize(1);
  character.joints[0].name = "humanoid_root";
  character.positions = {{-0.3f, 0.5f, -0.3f}, {0.3f, 0.5f, -0.3f}, {0, 0.5f, 0.5f}};
  character.normals.assign(3, {0, 1, 0});
  character.appearances.resize(1);
  character.appearances[0].double_sided = true;
  character.parts = {{.name = "all", .appearance = 0, .triangles = {{0, 1, 2}}}};
  character.first_weight = {0, 1, 2, 3};
  character.weights.assign(3, {0, 1});
  return character;
}

}  // namespace wellspring::test
