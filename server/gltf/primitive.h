// SPDX-License-Identifier: Apache-2.0
// The triangles of a primitive (glTF 2.0 section 3.7.2.1) and which of its vertices they use.
#pragma once
#include "base/vec.h"
#include "gltf/attributes.h"

namespace wellspring::gltf {

struct Corners {
  std::vector<uvec3> triangles;  // into `used`
  Used used;                     // the file's vertices, each once
};

// Strips and fans become triangles, those with two corners at one vertex go. Counts towards the
// file's limits; throws LoadError beyond them and for indices out of range. Points and lines: none.
Corners read_corners(File& file, const json& primitive, const std::string& where,
                     size_t vertex_count);

}  // namespace wellspring::gltf
