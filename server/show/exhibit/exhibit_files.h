// SPDX-License-Identifier: Apache-2.0
// The glTF files of a package and its environment become the exhibit's scene, with the credits that
// the files give.
#pragma once
#include "show/exhibit/json_fields.h"

namespace wellspring::show {

// Reads "scene" or "scenes", "scale", "light_scale" and "environment". Where a file cannot be read
// exhibit.scene.objects is empty.
void read_scene(Exhibit& exhibit, Fields& root, std::vector<Problem>& problems);

}  // namespace wellspring::show
