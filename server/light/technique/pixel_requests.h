// SPDX-License-Identifier: Apache-2.0
// What a still picture asks of its pixels, eight requests side by side.
#pragma once
#include <span>

#include "light/sample.h"
#include "world/view.h"

namespace wellspring::light {

// Sample `index` of the picture's pixel (x, y).
struct PixelSample {
  int x = 0, y = 0, index = 0;
};
// requests[i] asks for which[i]; its seed is the pixel's. What is asked beside it does not matter.
void make_pixel_requests(const View& view, uint64_t seed, std::span<const PixelSample> which,
                         std::span<Request> requests);

}  // namespace wellspring::light
