// SPDX-License-Identifier: Apache-2.0
// Reads the triangles of a primitive (glTF 2.0 section 3.7.2.1) and which of its vertices they use.
#pragma once
#include "base/vec.h"
#include "gltf/file.h"

namespace wellspring::gltf {

// Checks which formats the vertex attributes of a primitive may have (glTF 2.0 section 3.7.2.1 and
// KHR_mesh_quantization), and reads their values.

// Checks formats and counts of a primitive's attributes, targets and indices without reading them.
void check_primitive(File& file, const json& primitive, const std::string& where);

std::string numbered(const char* semantic, int set);  // "JOINTS_", 1 -> "JOINTS_1"

// Returns how many vertices a primitive can use at most.
int64_t vertex_bound(const File& file, const json& primitive);

// These read values of an attribute at the vertices `used`, an empty list if the object does not
// have it. A COLOR or WEIGHTS accessor of integers without "normalized" is read as if it had it.
// Colours of three components gain a 1.
using Used = std::vector<uint32_t>;
std::vector<float> read_attribute(File& file, const json& attributes, const std::string& semantic,
                                  const Used& used);
std::vector<vec2> read_vec2s(File&, const json& attributes, const std::string& semantic,
                             const Used&);
std::vector<vec3> read_vec3s(File&, const json& attributes, const std::string& semantic,
                             const Used&);
std::vector<vec4> read_vec4s(File&, const json& attributes, const std::string& semantic,
                             const Used&);

struct Corners {
  std::vector<uvec3> triangles;  // indices into `used`
  Used used;                     // the file's vertices, each once
};

// Turns strips and fans into triangles, without those that have two corners at one vertex. Counts
// towards the file's limits; throws LoadError beyond them and for indices out of range. Points and
// lines give no triangles.
Corners read_corners(File& file, const json& primitive, const std::string& where,
                     size_t vertex_count);

// Reads EXT_mesh_gpu_instancing: a node that shows its mesh many times.

// Returns where copies of the node's mesh stand, in the node's space: one at its origin if the node
// does not ask for more. They count towards instances_limit. Throws LoadError.
std::vector<dmat4> read_instances(File& file, size_t node);

}  // namespace wellspring::gltf
