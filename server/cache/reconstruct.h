// SPDX-License-Identifier: Apache-2.0
// Makes the picture of points alone as it was published (Walter, Drettakis, Parker 1999, section
// 3.1), for comparison with others.
#pragma once
#include <cstdint>

#include "cache/point_cache.h"
#include "cache/point_image.h"
#include "frame/frame.h"

namespace wellspring::cache {

// Figures of a picture of remembered points.

// Holds figures of the last frame (for /metrics, the status page and tests).
struct CacheStats {
  int points = 0;                                           // points in use
  float fresh = 0, reprojected = 0, filled = 0, empty = 0;  // shares of the picture's pixels
  float mean_age = 0;   // mean over the visible points, 0 (new) to 254; see age_points()
  float converged = 0;  // share of pixels whose point has reached its sample goal
};
// Counts a picture's pixels with a point, and those with one of `converged_samples` or more.
inline constexpr uint32_t converged_samples = 32;
struct ShownPoints {
  int64_t points = 0, converged = 0;
};

// Sets each pixel to the mean of the points in its 3x3 neighbourhood: weights are 4 for its own, 2
// for those beside it and 1 for those diagonally; a pixel without any stays as it was. Depth and
// object are those of the point of most weight; confidence is 0 without a point of its own. Resizes
// the frame.
ShownPoints reconstruct_points(const PointCache& points, const PointImage& image, Frame& frame);

}  // namespace wellspring::cache
