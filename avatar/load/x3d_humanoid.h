// SPDX-License-Identifier: Apache-2.0
// Reads the first HAnimHumanoid of a node tree. Rest is the H-Anim default pose: turns and moves of
// joints in the file are only noted.
#pragma once
#include "avatar/figure/character.h"
#include "avatar/load/x3d_node.h"

namespace wellspring::avatar {

Character character_from_x3d(X3dFile& file);

}  // namespace wellspring::avatar
