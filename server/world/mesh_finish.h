// SPDX-License-Identifier: Apache-2.0
// What a mesh needs besides its corners: normals from faces, tangents from texture coordinates.
#pragma once
#include "world/scene.h"

namespace wellspring {

// Splits the vertices so that no two triangles share one, and gives each its face's normal.
void make_flat_normals(Mesh& mesh);
// Replaces normals that are zero or not finite by the mean of the faces around; the rest become
// unit. Returns how many were replaced.
int repair_normals(Mesh& mesh);
// Tangents along u of texture coordinates `uv_set`, averaged over the faces around a vertex
// (Lengyel, Foundations of Game Engine Development 2, section 7.5). Vertices where the picture is
// mirrored are split. Needs normals and that uv set.
void make_tangents(Mesh& mesh, int uv_set);

}  // namespace wellspring
