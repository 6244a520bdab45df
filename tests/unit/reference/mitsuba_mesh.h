// SPDX-License-Identifier: Apache-2.0
// Meshes of Mitsuba's scenes: Wavefront OBJ, PLY with its per-vertex and per-face attributes, and
// its built-in shapes. Spheres become meshes fine enough that no pixel can tell.
#pragma once
#include <filesystem>

#include "world/scene.h"

namespace wellspring::mitsuba {

struct MeshWithAttributes {
  Mesh mesh;
  std::vector<vec3> vertex_color, face_color;  // empty: none
  std::vector<float> face_weight;
};

// Triangles and quads; texture coordinates with v turned round, as Mitsuba does by default. Throws
// LoadError.
MeshWithAttributes load_obj(const std::filesystem::path& file);
// Binary little-endian, triangles. Throws LoadError.
MeshWithAttributes load_ply(const std::filesystem::path& file);
MeshWithAttributes make_rectangle();
MeshWithAttributes make_sphere();

// Every edge is shared by two triangles (corners at the same place count as one).
bool is_closed(const Mesh& mesh);
// Gives every triangle corners of its own.
void split_faces(MeshWithAttributes& mesh);

}  // namespace wellspring::mitsuba
