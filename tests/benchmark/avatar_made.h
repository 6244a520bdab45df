// SPDX-License-Identifier: Apache-2.0
// A figure as avatars' exporters write them, made in a moment: a body of tubes about bones, a head
// with shapes, hair and a skirt of spring bones with colliders, twist bones, a map of normals, an
// expression that changes a material. Each can be left out, so that its cost shows.
#pragma once
#include <string>

#include "avatar/figure/character.h"

namespace wellspring::test {

struct MadeAvatar {
  bool springs = true, normal_map = true, constraints = true, paint = true;
};

// About 20,000 triangles whatever is left out. `normals`: a picture file for the map.
Character make_avatar(const MadeAvatar& what, const std::string& normals);

}  // namespace wellspring::test
