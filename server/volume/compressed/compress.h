// SPDX-License-Identifier: Apache-2.0
// Compresses volumes (see compressed_volume.h): trains the codebooks on a part of the blocks, then
// finds each block's code.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>

#include "base/layers.h"
#include "volume/compressed/compressed_volume.h"
#include "volume/volume.h"

namespace wellspring::volume {

struct CompressionSettings {
  int levels = 4;          // 1 to 8
  int codevectors = 4096;  // a level, 1 to 65536; a code has at most 56 bits
  // Codebooks are trained on this part of all blocks, but on no fewer and no more than these.
  double training_share = 0.05;
  int least_training_blocks = 1 << 14, most_training_blocks = 1 << 17;
  int most_rounds = 12;  // rounds of k-means a level
  uint64_t seed = 1;
  // Blocks of which no sample is above this are background: they are not trained on, and become
  // one flat colour, their mean. Without it blocks of zeros are background. Samples before slope
  // and intercept.
  std::optional<double> background;
};

// Returns the compressed volume, the same for the same seed and any number of threads. A level's
// codebook has fewer codevectors than asked for if the blocks trained on have fewer that differ:
// then these become what they were, up to the precision of codevectors. A further level never makes
// a block worse. Samples that are not of 8 or 16 bits are brought to uint16.
// `progress` is told the part that is done, 0 to 1, by the calling thread; work ends early with
// Cancelled (base/worker.h). Throws std::invalid_argument for settings out of range, and for a
// volume that is empty or has neither 1 channel nor 3 of 8 bits.
CompressedVolume compress_volume(const Volume& volume, const CompressionSettings& settings = {},
                                 const std::function<void(double)>& progress = {});

}  // namespace wellspring::volume
