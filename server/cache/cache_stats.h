// SPDX-License-Identifier: Apache-2.0
// What a picture of remembered points has shown, in numbers.
#pragma once
#include <cstdint>

namespace wellspring::cache {

// What the last frame looked like, in numbers (for /metrics, the status page and tests).
struct CacheStats {
  int points = 0;                                           // in use
  float fresh = 0, reprojected = 0, filled = 0, empty = 0;  // shares of the picture's pixels
  float mean_age = 0;   // of the visible points, 0 (new) to 254; see age_points()
  float converged = 0;  // share of pixels whose point has reached its sample goal
};
// Of a picture's pixels: those with a point, and with one of `converged_samples` or more.
inline constexpr uint32_t converged_samples = 32;
struct ShownPoints {
  int64_t points = 0, converged = 0;
};

}  // namespace wellspring::cache
