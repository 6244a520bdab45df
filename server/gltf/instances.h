// SPDX-License-Identifier: Apache-2.0
// EXT_mesh_gpu_instancing: a node that shows its mesh many times.
#pragma once
#include "base/vec.h"
#include "gltf/file.h"

namespace wellspring::gltf {

// Returns where copies of the node's mesh stand, in the node's space: one at its origin if the node
// does not ask for more. They count towards instances_limit. Throws LoadError.
std::vector<dmat4> read_instances(File& file, size_t node);

}  // namespace wellspring::gltf
