// SPDX-License-Identifier: Apache-2.0
// Reads all triangles of a glTF file as one surface, to be compared with a scan.
#pragma once
#include <string>

#include "volume/compare/surface_mesh.h"

namespace wellspring::world {

// Joins the triangles where the file's nodes put them; `metres` is worth one unit of the file.
// Throws LoadError that names file and place.
SurfaceMesh read_scene_surface(const std::string& file, double metres);

}  // namespace wellspring::world
