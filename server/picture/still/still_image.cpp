// SPDX-License-Identifier: Apache-2.0
#include "picture/still/still_image.h"

#include <algorithm>

#include "base/parallel.h"
#include "base/rng.h"
#include "cache/packing.h"

namespace wellspring::picture {

namespace {

constexpr int still_drawn = 4 * still_places;  // drawn pictures that the mean looks back on

}  // namespace

void accumulate_drawn(const std::function<bool(uint32_t)>& moves, bool changes, uint32_t seed,
                      StillImage& still, Frame& frame) {
  const int longest = changes ? still_places : still_drawn;
  size_t width = size_t(frame.width);
  parallel_ranges(frame.height, 8, [&](int begin, int end) {
    uint32_t last = 0;  // neighbours mostly show the same
    bool last_moves = moves(last);
    for (size_t i = size_t(begin) * width; i < size_t(end) * width; i++) {
      if (frame.object[i] != last) last_moves = moves(last = frame.object[i]);
      if (last_moves) {
        still.count[i] = 0;
        continue;
      }
      int n = std::min(still.count[i] + 1, longest);
      vec3 mean(unpack_half(still.mean[0][i]), unpack_half(still.mean[1][i]),
                unpack_half(still.mean[2][i]));
      // Later pictures count more: their light was known better.
      mean = n == 1 ? frame.color[i] : mean + (frame.color[i] - mean) * (1.5f / (float(n) + 0.5f));
      uint64_t random = mix64(uint64_t(seed) << 32 | i);
      for (size_t c = 0; c < 3; c++)
        still.mean[c][i] = pack_half(mean[int(c)], uint32_t(random >> (16 * c)));
      still.count[i] = uint8_t(n);
      frame.color[i] = mean;
    }
  });
}

}  // namespace wellspring::picture
