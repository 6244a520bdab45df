// SPDX-License-Identifier: Apache-2.0
// X3D Appearance to a Look. PhysicalMaterial is taken as it is (linear factors). The older Material
// is converted: its colours are display values (sRGB), its highlight sets the roughness.
#pragma once
#include "avatar/figure/character.h"
#include "avatar/load/x3d_node.h"

namespace wellspring {

struct X3dLook {
  Look look;
  mat3 uv_transform{1};  // TextureTransform, for X3D texture coordinates
};

// `appearance` < 0: the default look. `color`: the geometry's own colour, which replaces the
// material's.
X3dLook make_x3d_look(X3dFile& file, int appearance, const vec3* color);

}  // namespace wellspring
