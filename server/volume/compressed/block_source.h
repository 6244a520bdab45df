// SPDX-License-Identifier: Apache-2.0
// Blocks of a volume as the vectors that codebooks are made of.
#pragma once
#include <glm/glm.hpp>
#include <optional>

#include "base/layers.h"
#include "volume/volume.h"

namespace wellspring::volume {

// A volume whose samples are, or are brought to, one of the kinds that can be compressed.
struct BlockSource {
  Volume volume;
  SampleKind kind = SampleKind::u8;  // u8, u16 or i16; colours u8
  bool brought = false;              // coded sample: round((s - least) * scale)
  double least = 0, scale = 1;
  double slope = 1, intercept = 0;  // coded samples measure this
  int dimensions() const { return 64 * volume.channels; }
};

// Samples of 8 and 16 bits stay what they are. All others are brought to uint16 over the range of
// their finite values; those that are not finite become the least. Throws std::invalid_argument if
// the volume is empty, has neither 1 nor 3 channels, or colours that are not of 8 bits.
BlockSource make_block_source(const Volume& volume);

// Writes the coded samples of block `block`, x fastest, channels side by side. Blocks that reach
// beyond the volume repeat its last voxels.
void read_block(float* to, const BlockSource& source, glm::ivec3 block);

// Returns whether all samples are 0 or, with a threshold, none is above it. A threshold is of
// samples as the volume has them, before slope and intercept.
bool is_background(const BlockSource& source, const float* block, std::optional<double> threshold);

}  // namespace wellspring::volume
