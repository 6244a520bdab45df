// SPDX-License-Identifier: Apache-2.0
// Completes a mesh: normals from faces, tangents from texture coordinates, and the winding of its
// mirror image.
#pragma once
#include "world/scene.h"

namespace wellspring::world {

// Splits the vertices so that no two triangles share one, and gives each its face's normal. Vertex
// i of the result is vertex answer[i] of the mesh before.
std::vector<uint32_t> make_flat_normals(Mesh& mesh);
// Replaces normals that are zero or not finite by the mean of the faces around; the rest become
// unit. Returns how many were replaced.
int repair_normals(Mesh& mesh);
// Makes tangents along u of texture coordinates `uv_set`, averaged over the faces around a vertex
// (Lengyel, Foundations of Game Engine Development 2, section 7.5). Vertices between mirrored and
// plain pictures are split. Needs normals and that uv set. Vertex i of the result is vertex
// answer[i] of the mesh before.
std::vector<uint32_t> make_tangents(Mesh& mesh, int uv_set);
// Does the same for a mesh with tangents whose vertices have moved: they stay split as they are,
// and keep the sign of their bitangent.
void update_tangents(Mesh& mesh, int uv_set);
// Turns a mesh that was mirrored: its triangles and bitangents become their mirror images'.
void turn_winding(Mesh& mesh);
// Returns the set of texture coordinates for tangents: of a normal map or anisotropy; -1: the
// material has neither.
int tangent_uv(const Material& material);

}  // namespace wellspring::world
