// SPDX-License-Identifier: Apache-2.0
// Tells how far a compressed volume is from what was compressed.
#pragma once
#include <cstdint>
#include <optional>

#include "base/layers.h"
#include "volume/compressed/compressed_volume.h"
#include "volume/volume.h"

namespace wellspring::volume {

struct CodingLoss {
  double mean_square = 0;                   // coded samples are 0 to 255 or 65535
  double decibel = 0;                       // peak signal to noise; infinite if nothing was lost
  double bits_a_voxel = 0;                  // counts header, codes, codebooks, ranges
  uint64_t foreground = 0, background = 0;  // blocks
};

// Compares all blocks that are no background (see CompressionSettings::background), as the paper
// does (section 3.1.1). Throws std::invalid_argument if the sizes or channels differ.
CodingLoss compare_compressed(const Volume& volume, const CompressedVolume& compressed,
                              std::optional<double> background = std::nullopt);

}  // namespace wellspring::volume
