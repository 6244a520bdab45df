// SPDX-License-Identifier: Apache-2.0
// While the view stands still, rays are spread over their pixels; the mean of what a pixel showed
// after each of its samples is the antialiased picture. 7 bytes a pixel.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "cache/point_cache.h"
#include "cache/point_image.h"
#include "frame/frame.h"

namespace wellspring {

inline constexpr uint8_t still_fresh =
    128;  // bit of `count`: a sample arrived since the last picture
inline constexpr int still_longest = 100;  // the mean looks back on about this many samples

struct StillImage {
  std::array<std::vector<uint16_t>, 3> mean;  // pack_half
  std::vector<uint8_t> count;                 // low 7 bits: samples in the mean
};

// Averages what fresh pixels show into `still` and shows the average. Pixels of moving points start
// over.
void accumulate_still(const PointCache& points, const PointImage& image, uint32_t seed,
                      StillImage& still, Frame& frame);

}  // namespace wellspring
