// SPDX-License-Identifier: Apache-2.0
// Loads files of figures, told apart by their content: H-Anim in X3D's encodings and VRML97, glTF
// skins, VRM, BVH. Throws LoadError naming file and line (or node). The cost is linear in the file.
#pragma once
#include <string>

#include "avatar/figure/character.h"

namespace wellspring::avatar {

Character load_character(const std::string& path);

}  // namespace wellspring::avatar
