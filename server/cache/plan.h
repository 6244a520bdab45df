// SPDX-License-Identifier: Apache-2.0
// Which pixels are asked for next: error diffusion over the priorities (Walter 1999, section 4), in
// blocks of scanlines that are dithered independently, each with its share of the budget.
#pragma once
#include <vector>

#include "cache/point_cache.h"
#include "cache/point_image.h"
#include "light/sample.h"
#include "world/view.h"

namespace wellspring::cache {

struct PlanSettings {
  int budget = 0;
  uint64_t seed = 0;
  // The view stands still: most rays are spread over their pixel, so that the picture gets
  // antialiased. Otherwise a pixel with a point is resampled exactly through that point.
  bool still = false;
};

// Overwrites `requests`: exactly `budget`, at most one a pixel; fewer only if fewer pixels have a
// priority. Sets the priority of the chosen pixels to 0. A function of its arguments alone.
void plan_requests(const PointCache& points, const View& view, const PlanSettings& settings,
                   PointImage& image, std::vector<Request>& requests);

}  // namespace wellspring::cache
