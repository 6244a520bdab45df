// SPDX-License-Identifier: Apache-2.0
// Which pixels are sampled while the view stands still: all of them in turn, so that any number of
// samples is spread evenly: a quarter of a sample a pixel is one for each square of 2x2 pixels. The
// samples of a pixel are those of its sequence (light/technique/pixel_requests.h).
#pragma once
#include <cstdint>
#include <vector>

#include "light/sample.h"
#include "world/view.h"

namespace wellspring {

// Appends `count` requests for the samples [first, first + count) of the view's sequence.
void plan_still(const View& view, uint64_t first, int count, uint64_t seed,
                std::vector<Request>& requests);

}  // namespace wellspring
