// SPDX-License-Identifier: Apache-2.0
// Reads single voxels of a compressed volume, without decoding their blocks: each costs one number
// of every level.
#pragma once
#include <glm/glm.hpp>

#include "base/layers.h"
#include "volume/compressed/compressed_volume.h"

namespace wellspring::volume {

// Returns what a voxel measures, neither rounded nor cut, as decode() to floats does. Grey: all
// three are the same. Voxels outside repeat the volume's nearest.
glm::vec3 fetch(const CompressedVolume& volume, glm::ivec3 voxel);

// Returns the same between voxels, trilinear. Voxel (x, y, z) has its centre at (x, y, z).
glm::vec3 fetch_between(const CompressedVolume& volume, glm::vec3 position);

}  // namespace wellspring::volume
