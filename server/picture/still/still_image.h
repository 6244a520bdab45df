// SPDX-License-Identifier: Apache-2.0
// The mean over the last drawn pictures of a view that stands still, each seen at another place of
// its pixels, is the antialiased picture. 7 bytes a pixel.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "base/vec.h"
#include "frame/frame.h"

namespace wellspring::picture {

struct StillImage {
  std::array<std::vector<uint16_t>, 3> mean;  // pack_half
  std::vector<uint8_t> count;                 // of pictures in the mean; 0: begins anew
};

// Pictures, each seen at another place of the pixels (base/spread.h), that antialias well enough.
inline constexpr int still_places = 16;

// Averages a drawn picture into `still` and shows the average, but for pixels of objects of which
// `moves` says so. `changes`: the light does, and the mean is over few pictures.
void accumulate_drawn(const std::function<bool(uint32_t)>& moves, bool changes, uint32_t seed,
                      StillImage& still, Frame& frame);

}  // namespace wellspring::picture
