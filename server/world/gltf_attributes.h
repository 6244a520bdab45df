// SPDX-License-Identifier: Apache-2.0
// The vertex attributes of a primitive: which formats each may have (glTF 2.0 section 3.7.2.1 and
// KHR_mesh_quantization), and their values.
#pragma once
#include "base/vec.h"
#include "world/gltf.h"

namespace wellspring::gltf {

// Checks formats and counts of a primitive's attributes, targets and indices without reading them.
void check_primitive(File& file, const json& primitive, const std::string& where);

std::string numbered(const char* semantic, int set);  // "JOINTS_", 1 -> "JOINTS_1"

// Values of an attribute, an empty list where the object has none. A COLOR or WEIGHTS accessor of
// integers that forgot to say "normalized" is read as if it had. Colours of three components gain a 1.
std::vector<float> read_attribute(File& file, const json& attributes, const std::string& semantic);
std::vector<vec2> read_vec2s(File& file, const json& attributes, const std::string& semantic);
std::vector<vec3> read_vec3s(File& file, const json& attributes, const std::string& semantic);
std::vector<vec4> read_vec4s(File& file, const json& attributes, const std::string& semantic);

}  // namespace wellspring::gltf
