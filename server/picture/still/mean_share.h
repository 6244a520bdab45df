// SPDX-License-Identifier: Apache-2.0
// The more samples of a view at rest there are, the more of their plain mean its picture is: each
// region takes the share that has the least error by their noise (James and Stein 1961), so that
// the picture becomes the reference.
#pragma once
#include <vector>

#include "base/vec.h"
#include "picture/still/still_samples.h"

namespace wellspring {

// Mixes the samples' means into `color`, a picture of `size` pixels; those without a sample stay.
// `shares`: scratch.
void mix_in_means(const StillSamples& samples, ivec2 size, std::vector<float>& shares,
                  std::vector<vec3>& color);

}  // namespace wellspring
