// SPDX-License-Identifier: Apache-2.0
#include "cache/still_image.h"

#include <algorithm>

#include "base/parallel.h"
#include "base/rng.h"
#include "cache/packing.h"

namespace wellspring {

void accumulate_still(const PointCache& points, const PointImage& image, uint32_t seed,
                      StillImage& still, Frame& frame) {
  parallel_ranges(image.height, 8, [&](int begin, int end) {
    size_t first = size_t(begin) * size_t(image.width), last = size_t(end) * size_t(image.width);
    for (size_t i = first; i < last; i++) {
      uint32_t point = image.point[i];
      if (point == no_point || (points.flags[point] & point_moving)) {
        still.count[i] = 0;
        continue;
      }
      int n = still.count[i] & ~still_fresh;
      vec3 mean(unpack_half(still.mean[0][i]), unpack_half(still.mean[1][i]),
                unpack_half(still.mean[2][i]));
      if (still.count[i] & still_fresh) {
        n = std::min(n + 1, still_longest);
        // Later samples count more: the light they were shown in was known better.
        mean += (frame.color[i] - (n == 1 ? vec3(0) : mean)) *
                    (n == 1 ? 1.0f : 1.5f / (float(n) + 0.5f)) -
                (n == 1 ? mean : vec3(0));
        uint64_t random = mix64(uint64_t(seed) << 32 | i);
        for (size_t c = 0; c < 3; c++)
          still.mean[c][i] = pack_half(mean[int(c)], uint32_t(random >> (16 * c)));
        still.count[i] = uint8_t(n);
      }
      if (n == 0) continue;
      float share = float(n) / (float(n) + 2);
      frame.color[i] += (mean - frame.color[i]) * share;
      frame.confidence[i] = std::max(frame.confidence[i], float(n) / (float(n) + 8));
    }
  });
}

}  // namespace wellspring
