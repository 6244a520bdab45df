// SPDX-License-Identifier: Apache-2.0
// Two independent renders of one picture tell their own noise; two such pairs tell whether two
// programs agree to within it. Linear luminance.
#pragma once
#include "frame/frame.h"

namespace wellspring::test {

// Two renders of different seeds and the same cost.
struct PicturePair {
  Frame a, b;
  double seconds = 0, processor_seconds = 0;  // time of one of them
};

// Root mean squared error of one of the pair, over pixels and channels.
double noise(const PicturePair& pair);

// Holds the difference of `ours` less `theirs`, pictures of one size.
struct Agreement {
  double relative_mean = 0, relative_error = 0;  // mean of all pixels, and its standard error
  // Blocks of 8 x 8 pixels: difference over its standard error, root mean square; 1 for noise
  // alone.
  double block_z = 0;
  // correlation of neighbouring blocks; 0 without structure
  double correlation = 0, correlation_error = 0;
};
Agreement compare_pairs(const PicturePair& ours, const PicturePair& theirs);

}  // namespace wellspring::test
