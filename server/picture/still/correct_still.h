// SPDX-License-Identifier: Apache-2.0
// A picture at rest is drawn in filtered light, which has little noise but errs where light, gloss
// or edges vary more finely than filters see; the means of its samples alone have no such error but
// all the noise. What the two differ by is taken apart into scales, and of each scale the share is
// added to the picture by which it exceeds its noise (a Wiener filter for each place and scale: Lee
// 1980; Burt and Adelson 1983 for the pyramid). So the picture becomes the mean of its samples as
// they become many, and stays as it is where they say nothing yet; first samples correct nothing,
// as nobody knows by how much they are off.
#pragma once
#include <array>
#include <vector>

#include "frame/frame.h"
#include "picture/still/still_image.h"
#include "picture/still/still_samples.h"

namespace wellspring {

// One scale: sums over squares of pixels, and what is to be added there, weighed likewise.
struct ResidualLevel {
  int width = 0, height = 0;
  std::array<std::vector<float>, 3> sum, added;  // sum: of weight times residual
  std::vector<float>
      weight;  // the inverse of the variance that each mean has by what its surroundings say
  std::vector<float>
      noise;  // sum of weights times how much noisier a pixel's own samples say it is
};

// Scratch, overwritten by every call.
struct StillCorrection {
  int columns = 0, rows = 0;                       // blocks of 4x4 pixels
  std::vector<float> block_spread, block_samples;  // of one sample's variance: sums, and of what
  std::vector<float> spread, samples;              // the same over 3x3 blocks
  std::vector<vec3> color;                         // corrected
  std::array<ResidualLevel, 5> levels;             // squares of 2 to 32 pixels a side
};
size_t memory_bytes(const StillCorrection& work);

// Corrects `frame`, a picture drawn in the mean (accumulate_drawn()), but where `still` has none:
// what moves. The same bits whatever the number of threads.
void correct_still(const StillSamples& samples, const StillImage& still, StillCorrection& work,
                   Frame& frame);

}  // namespace wellspring
