// SPDX-License-Identifier: Apache-2.0
// Something to look at where a file has only a skeleton: a slender double pyramid for each bone.
#pragma once
#include "avatar/figure/character.h"

namespace wellspring::avatar {

// Adds bones to a figure without parts; leaves others as they are.
void add_bone_surface(Character& character);

}  // namespace wellspring::avatar
