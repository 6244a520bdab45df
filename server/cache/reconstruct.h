// SPDX-License-Identifier: Apache-2.0
// The picture of points alone as it was published (Walter, Drettakis, Parker 1999, section 3.1):
// what others are compared with.
#pragma once
#include "cache/cache_stats.h"
#include "cache/point_cache.h"
#include "cache/point_image.h"
#include "frame/frame.h"

namespace wellspring::cache {

// Each pixel becomes the mean of the points in its 3x3 neighbourhood: weights 4 for its own, 2 for
// those beside it and 1 for those diagonally; where there are none it stays as it was. Depth and
// object are those of the point of most weight; confidence is 0 without a point of its own. Resizes
// the frame.
ShownPoints reconstruct_points(const PointCache& points, const PointImage& image, Frame& frame);

}  // namespace wellspring::cache
