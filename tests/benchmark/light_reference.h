// SPDX-License-Identifier: Apache-2.0
// A converged picture by `path`, and how far it still is from the truth: it is made of two
// independent halves, whose difference tells the noise of their mean.
#pragma once
#include "light/technique/technique.h"

namespace wellspring::test {

struct Reference {
  Frame frame;
  double seconds = 0;
  int spp = 0;  // samples a pixel of both halves together
  // Standard error of the frame, as the measures of judge/compare.h and judge/flip.h say it.
  double rmse = 0, relative_mse = 0;
  double flip = 0;  // between the halves over sqrt(2): an upper bound, FLIP grows less than noise
};

// Ends after about `seconds`, and after at least two passes of eight samples a pixel.
Reference make_reference(const World& world, const Lights& lights, const View& view,
                         const TransportSettings& transport, double seconds);

}  // namespace wellspring::test
