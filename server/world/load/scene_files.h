// SPDX-License-Identifier: Apache-2.0
// The files that a glTF file consists of.
#pragma once
#include <string>
#include <vector>

namespace wellspring::world {

// Of buffers and pictures that lie beside a .gltf or .glb: paths relative to its folder, each once;
// not the file itself, and none of those that are missing. Throws LoadError.
std::vector<std::string> list_scene_files(const std::string& path);

}  // namespace wellspring::world
