// SPDX-License-Identifier: Apache-2.0
// Writes a surface with a colour at each vertex as glTF.
#pragma once
#include <string>
#include <vector>

#include "volume/compare/surface_mesh.h"

namespace wellspring::volume {

// Returns the bytes of a GLB (glTF 2.0, section 4) with one mesh: positions as floats, which the
// node's translation moves to their places; normals; and COLOR_0, 16 bits a channel, linear RGB.
// `colors` are as many as positions. Triangles with a vertex that is not finite are left out.
std::string colored_glb(const SurfaceMesh& mesh, const std::vector<vec3>& colors,
                        const std::string& name);

}  // namespace wellspring::volume
