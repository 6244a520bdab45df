// SPDX-License-Identifier: Apache-2.0
// Decodes boxes of a compressed volume, at 1:1, 2:1 or 4:1. Coarser voxels are means of the
// decoded ones, by codebooks of means (paper section 3.2.5).
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "base/layers.h"
#include "volume/compressed/compressed_volume.h"

namespace wellspring::volume {

// Voxels of one detail, which may lie outside of the volume.
struct Box {
  glm::ivec3 first{0}, size{0};
};

// Returns a brick's voxels at a detail, with so many more at each side.
Box brick_box(glm::ivec3 brick, int detail, int skirt);

// Writes the raw samples of a box, x fastest, channels side by side, rounded and cut to the kind.
// Voxels outside repeat the volume's nearest. Runs on the calling thread. Throws
// std::invalid_argument if the box does not meet the volume, `samples` has another size than the
// box, or the volume is of another kind.
void decode(std::span<uint8_t> samples, const CompressedVolume& volume, int detail, Box box);
void decode(std::span<uint16_t> samples, const CompressedVolume& volume, int detail, Box box);
void decode(std::span<int16_t> samples, const CompressedVolume& volume, int detail, Box box);
// Writes what the samples of any kind measure, neither rounded nor cut.
void decode(std::span<float> samples, const CompressedVolume& volume, int detail, Box box);

}  // namespace wellspring::volume
