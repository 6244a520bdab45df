// SPDX-License-Identifier: Apache-2.0
// Which pixels are sampled while the view stands still: all of them in turn, so that any number of
// samples is spread evenly: a quarter of a sample a pixel is one for each square of 2x2 pixels. The
// samples of a pixel are those of its sequence (light/technique/pixel_requests.h).
#pragma once
#include <cstdint>
#include <vector>

#include "cache/point_image.h"
#include "light/sample.h"
#include "picture/still/still_samples.h"
#include "world/view.h"

namespace wellspring::picture {

// Appends `count` requests for the samples [first, first + count) of the view's sequence.
void plan_still(const View& view, uint64_t first, int count, uint64_t seed,
                std::vector<Request>& requests);

// The same where cells of the view count differently (PointImage::weight, of that view, which is
// not empty): each time that its turn comes, a pixel has as many samples as its cell counts, once
// in so many turns where that is less than one; none where `kept` has most_still_samples. Of a
// pixel's sequence those after as many as `kept` has. Appends at most `count`, of at most a round
// of all pixels. Returns which sample would come next.
uint64_t plan_still(const View& view, uint64_t first, int count, uint64_t seed,
                    const PointImage& image, const StillSamples& kept,
                    std::vector<Request>& requests);

}  // namespace wellspring::picture
