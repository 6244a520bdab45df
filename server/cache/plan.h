// SPDX-License-Identifier: Apache-2.0
// Chooses the pixels to ask for next: error diffusion over the priorities (Walter 1999, section 4),
// in blocks of scanlines that are dithered independently, each with its share of the budget.
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

// Overwrites `requests` with exactly `budget`, at most one a pixel; with fewer only if fewer pixels
// have a priority. Sets the priority of the chosen pixels to 0. The result depends on the arguments
// alone.
void plan_requests(const PointCache& points, const View& view, const PlanSettings& settings,
                   PointImage& image, std::vector<Request>& requests);

// Requests samples for what is about to come into view (Walter, Drettakis, Greenberg 2002, section
// on predictive sampling): between question and answer lies at least a picture's time, so that the
// leading edge of a turning view would always be guessed.

// Returns the view after `steps` more of the motion that led from `before` to `now`: straight on,
// and round the same axis. Returns `now` itself if there is no motion to go on with: another size
// or field of view, a turn by more than `largest_turn` radians, or places that are not finite.
inline constexpr float largest_turn = 0.5f;
View extrapolate(const View& before, const View& now, float steps);

// Finds which cells of `cell_pixels` a side of the view `ahead` any point falls into, without a
// z-buffer: one byte each, rows of cells one after the other. Overwrites `cells`.
inline constexpr int cell_pixels = 4;
void find_occupied(const PointCache& points, const View& ahead, std::vector<uint8_t>& cells);

// Appends at most `most` rays of `ahead` through cells where no point falls, each at a random place
// of its cell; if there are more cells, evenly chosen ones. The rays have no pixel: their answers
// show when they are in view. `cells`: scratch.
void predict_requests(const PointCache& points, const View& ahead, int most, uint64_t seed,
                      std::vector<uint8_t>& cells, std::vector<Request>& requests);

}  // namespace wellspring::cache
