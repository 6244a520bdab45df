// SPDX-License-Identifier: Apache-2.0
// Fetches the samples that a header describes.
#pragma once
#include <cstdint>

#include "volume/format/stored_volume.h"

namespace wellspring::volume {

struct VolumeLimits {
  uint64_t memory = uint64_t(4) << 30;        // most bytes of one volume that are kept in memory
  uint64_t mapped_from = uint64_t(64) << 20;  // samples of so many bytes stay in their file
};

// Returns the samples of one time. Samples that lie in one file as this machine wants them, and are
// many, are mapped: they are read when they are looked at, and the file must not shrink meanwhile.
// All others are read into memory, which is touched only as data arrive. Throws LoadError: a file
// is too short for what the header says (with both numbers), packed data are damaged or hold more
// than it says, or the volume is larger than the limit.
Volume load_samples(const StoredVolume& stored, int64_t time, const VolumeLimits& limits);

}  // namespace wellspring::volume
