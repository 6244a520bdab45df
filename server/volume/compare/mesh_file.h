// SPDX-License-Identifier: Apache-2.0
// Reads the files of surfaces that printers and scanners write.
#pragma once
#include <string>

#include "volume/compare/surface_mesh.h"

namespace wellspring::volume {

// Returns whether the file's name is one of those that are read here: .stl or .ply.
bool is_mesh_file(const std::string& file);

// Reads STL (binary or text) or PLY (text or binary, of either byte order; faces of several corners
// become fans), at most 2^30 bytes. The files do not say their unit: `metres` is what theirs is
// worth, 0.001 for millimetres. Vertices are welded. Throws LoadError with file and place.
SurfaceMesh read_mesh_file(const std::string& file, double metres);

}  // namespace wellspring::volume
