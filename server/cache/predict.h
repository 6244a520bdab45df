// SPDX-License-Identifier: Apache-2.0
// Requests for what is about to come into view (Walter, Drettakis, Greenberg 2002, section on
// predictive sampling): between question and answer lies at least a picture's time, so that the
// leading edge of a turning view would always be guessed.
#pragma once
#include <vector>

#include "cache/point_cache.h"
#include "light/sample.h"
#include "world/view.h"

namespace wellspring::cache {

// The view after `steps` more of the motion that led from `before` to `now`: straight on, and round
// the same axis. `now` itself where there is no motion to go on with: another size or field of
// view, a turn by more than `largest_turn` radians, or places that are not finite.
inline constexpr float largest_turn = 0.5f;
View extrapolate(const View& before, const View& now, float steps);

// Which cells of `cell_pixels` a side of the view `ahead` any point falls into, without a z-buffer:
// one byte each, rows of cells one after the other. Overwrites `cells`.
inline constexpr int cell_pixels = 4;
void find_occupied(const PointCache& points, const View& ahead, std::vector<uint8_t>& cells);

// Appends rays of `ahead` through cells where no point falls, each at a random place of its cell,
// at most `most`; of more cells an even choice. They have no pixel: their answers show when they
// are in view. `cells`: scratch.
void predict_requests(const PointCache& points, const View& ahead, int most, uint64_t seed,
                      std::vector<uint8_t>& cells, std::vector<Request>& requests);

}  // namespace wellspring::cache
