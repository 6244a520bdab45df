// SPDX-License-Identifier: Apache-2.0
// Makes one splat of several: mean and covariance of the mixture, and as much of a picture covered.
#pragma once
#include "scan/splats/splat_set.h"

namespace wellspring::scan {

// Appends splat `i` of `from`, its place minus `middle`. Both have the same degree.
void append_splat(SplatSet& set, const SplatSet& from, size_t i, vec3 middle);

// Merges splats in each cube of a grid into one; splats that are larger than a cell only with
// others that are, too. Splats that are alone stay as they are.
SplatSet merge_in_cells(const SplatSet& set, float cell);

}  // namespace wellspring::scan
