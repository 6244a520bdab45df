// SPDX-License-Identifier: Apache-2.0
// While the view stands still, rays are spread over their pixels; the mean of what a pixel showed
// after each of its samples is the antialiased picture. Of pictures that are drawn, seen at another
// place of their pixels each time, it is the mean over the last of them. 7 bytes a pixel.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "cache/point_cache.h"
#include "cache/point_image.h"
#include "frame/frame.h"

namespace wellspring {

inline constexpr uint8_t still_fresh =
    128;  // bit of `count`: a sample arrived since the last picture
inline constexpr int still_longest = 100;  // the mean looks back on about this many samples

inline constexpr uint8_t still_relit = 127;  // instead of a number: the mean is over light

struct StillImage {
  std::array<std::vector<uint16_t>, 3> mean;  // pack_half; empty while nothing is accumulated
  std::vector<uint8_t> count;                 // low 7 bits: samples in the mean, or still_relit
};

// The light changes of points where `forgotten` (called before they are told): their pixels' means
// keep what they know of the surface, which is the mean over the light of the point that shows.
template <class Forgotten>
void relight_still(const PointCache& points, const PointImage& image, const Forgotten& forgotten,
                   StillImage& still);

// Averages what fresh pixels show into `still` and shows the average. Pixels of moving points start
// over.
void accumulate_still(const PointCache& points, const PointImage& image, uint32_t seed,
                      StillImage& still, Frame& frame);

// Where in their pixels the picture after `pictures` others is seen: any `still_places` of them in
// a row are spread evenly.
inline constexpr int still_places = 16;
vec2 still_place(int pictures);

// Averages a drawn picture into `still` and shows the average, but for pixels of objects of which
// `moves` says so. `changes`: the light does, and the mean is over few pictures.
void accumulate_drawn(const std::function<bool(uint32_t)>& moves, bool changes, uint32_t seed,
                      StillImage& still, Frame& frame);

// Implementation of the template: of one pixel, whose point's light is forgotten.
void relight_still_pixel(const PointCache& points, uint32_t point, size_t pixel, StillImage& still);

template <class Forgotten>
void relight_still(const PointCache& points, const PointImage& image, const Forgotten& forgotten,
                   StillImage& still) {
  for (size_t i = 0; i < std::min(still.count.size(), image.point.size()); i++) {
    uint32_t point = image.point[i];
    if (point == no_point)
      still.count[i] = 0;
    else if (forgotten(point))
      relight_still_pixel(points, point, i, still);
  }
}

}  // namespace wellspring
