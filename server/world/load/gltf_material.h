// SPDX-License-Identifier: Apache-2.0
// Loads materials, textures and samplers of a glTF file. Only pictures that a material uses are
// opened.
#pragma once
#include "gltf/file.h"
#include "world/scene.h"

namespace wellspring::world {

// Fills scene.materials (0 is the default material, i + 1 the file's material i), textures and
// images.
void load_materials(File& file, Scene& scene);

}  // namespace wellspring::world
