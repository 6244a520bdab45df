// SPDX-License-Identifier: Apache-2.0
// Where a surface with alpha lets a ray pass; asked by Embree's filter functions (world_rays.cpp).
#pragma once
#include "world/world.h"

namespace wellspring::world {

// Can any place of this mesh be passed through? Only such meshes get a filter function.
bool may_pass(const Mesh& mesh, const Material& material);
// May some place of it be a thin pane, which tints light and does not stop it?
bool may_be_pane(const Material& material);
// Is this hit passed through? Mask: alpha below the cut-off. Blend: with probability 1 - alpha,
// decided by a hash of the ray's origin and direction and of which triangle it is, so the answer
// repeats.
bool passes(const Scene& scene, const PlacedMesh& placed, uint32_t instance, uint32_t triangle,
            vec2 barycentric, const Ray& ray);

}  // namespace wellspring::world
