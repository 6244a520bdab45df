// SPDX-License-Identifier: Apache-2.0
// Makes plain volumes of compressed ones.
#pragma once
#include "volume/compressed/compressed_volume.h"
#include "volume/volume.h"

namespace wellspring::volume {

// Decodes all of a compressed volume at a detail: 0 for 1:1, 1 for 2:1, 2 for 4:1. Coarser samples
// lie in the middle of those that they are the mean of.
Volume to_volume(const CompressedVolume& compressed, int detail = 0);

}  // namespace wellspring::volume
