// SPDX-License-Identifier: Apache-2.0
// Turns an X3D Appearance into ours. PhysicalMaterial is taken as it is (linear factors). The older
// Material is converted: its colours are display values (sRGB), its highlight sets the roughness.
#pragma once
#include "avatar/figure/character.h"
#include "avatar/load/x3d_node.h"

namespace wellspring::avatar {

struct X3dAppearance {
  Appearance appearance;
  mat3 uv_transform{1};  // TextureTransform, for X3D texture coordinates
};

// Makes an appearance; `appearance_node` < 0: the default one. `colors` are the geometry's own, one
// a vertex, as written. They take the place of the material's colour, which is white then, and
// become linear; they are cleared if they are not shown (under a picture that replaces all colours,
// or by a material that only glows).
X3dAppearance make_x3d_appearance(X3dFile& file, int appearance_node, std::vector<vec4>& colors);

}  // namespace wellspring::avatar
