// SPDX-License-Identifier: Apache-2.0
// Small things in large scenes: where a float's step in world coordinates is no longer small beside
// an instance's triangles, these are kept relative to its place, and rays of the whole scene start
// as near to surfaces as rounding allows. Scenes that need none of it are left as they are.
#pragma once
#include <vector>

#include "world/world.h"

namespace wellspring::world {

// Sets PlacedMesh::apart and steps. The first of `placed` are the scene's instances.
void mark_far(const Scene& scene, std::vector<PlacedMesh>& placed);

}  // namespace wellspring::world
