// SPDX-License-Identifier: Apache-2.0
// Gives a surface to files that have only a skeleton: a slender double pyramid for each bone.
#pragma once
#include "avatar/figure/character.h"

namespace wellspring::avatar {

// Adds bones to a figure without parts; leaves others as they are.
void add_bone_surface(Character& character);

}  // namespace wellspring::avatar
