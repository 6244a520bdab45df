// SPDX-License-Identifier: Apache-2.0
// Handles small things in large scenes: if a float's step in world coordinates is no longer small
// beside an instance's triangles, these are kept relative to the instance's place, and rays of the
// whole scene start as near to surfaces as rounding allows. Scenes that need none of it are left as
// they are.
#pragma once
#include <vector>

#include "world/world.h"

namespace wellspring::world {

// Decides where a surface with alpha lets a ray pass; called by Embree's filter functions
// (world_build.cpp).

// Returns whether rays can pass any place of this mesh. Only such meshes get a filter function.
bool may_pass(const Mesh& mesh, const Material& material);
// Returns whether some place of the material may be a thin pane, which tints light and does not
// stop it.
bool may_be_pane(const Material& material);
// Returns whether the ray passes this hit. Mask: alpha below the cut-off. Blend: with probability 1
// - alpha, decided by a hash of the ray's origin and direction and of the triangle, so the answer
// repeats.
bool passes(const Scene& scene, const PlacedMesh& placed, uint32_t instance, uint32_t triangle,
            vec2 barycentric, const Ray& ray);

// Sets PlacedMesh::apart and steps. The first of `placed` are the scene's instances.
void mark_far(const Scene& scene, std::vector<PlacedMesh>& placed);

}  // namespace wellspring::world
