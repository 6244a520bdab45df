// SPDX-License-Identifier: Apache-2.0
// The animations of a glTF file, checked and read.
#pragma once
#include <vector>

#include "gltf/clip.h"
#include "gltf/file.h"

namespace wellspring::gltf {

// Every animation of the file with its data; checked as animate() does.
std::vector<Clip> read_clips(File& file, const std::vector<Node>& nodes);

// Checks every animation's layout and the first one's data; then, unless `time` is 0, moves `nodes`
// to where the first animation has them.
void animate(File& file, double time, std::vector<Node>& nodes);

}  // namespace wellspring::gltf
