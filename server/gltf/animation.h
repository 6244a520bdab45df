// SPDX-License-Identifier: Apache-2.0
// Key frames of a glTF file: STEP, LINEAR (spherical for rotations) and CUBICSPLINE, appendix C.
#pragma once
#include "gltf/pose.h"

namespace wellspring::gltf {

// Checks every animation's layout and the first one's data; then, unless `time` is 0, moves `nodes`
// to where the first animation has them. Before its first and after its last key a channel holds
// still.
void animate(File& file, double time, std::vector<Node>& nodes);

}  // namespace wellspring::gltf
