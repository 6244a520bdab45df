// SPDX-License-Identifier: Apache-2.0
// Where surfaces meet, a pixel shows several, and a point shows one of them. There the renderer is
// asked what two places of the pixel see (light/see.h): exact shape and reflectance, without light.
// The light comes from the points and cells around that lie on the same surface. With a look at
// every pixel this is the display path `primary`: visibility and reflectance exact all over, every
// frame.
#pragma once
#include <span>
#include <vector>

#include "cache/cells.h"
#include "cache/point_image.h"
#include "cache/still_image.h"
#include "frame/frame.h"
#include "light/see.h"

namespace wellspring {

inline constexpr int looks_a_pixel = 2;

// How much a pixel would gain by being looked at: by how much the luminance that it is likely to
// show differs from its neighbours', twice that where another surface begins. Overwrites
// image.priority, which is free between remember() and attend(). The frame's planes hold a packed
// surface (cache/surface_image.h); pixels whose antialiased mean is well known gain nothing.
void find_edges(const View& view, const Cells& cells, const StillImage& still, const Frame& frame,
                PointImage& image);
// Overwrites `pixels`, in order: the `most` that gain most, of equals a choice that `seed` names;
// all of the picture where `most` is that many.
void choose_looks(const PointImage& image, size_t most, uint64_t seed,
                  std::vector<uint32_t>& pixels);

// The rays of these pixels, looks_a_pixel each, one after the other.
void make_looks(const View& view, std::span<const uint32_t> pixels, std::vector<Ray>& looks);

// What a pixel shows that was looked at.
struct LookedPixel {
  vec3 color{0};
  float depth = 0;  // of the nearest look, along the viewing axis
  uint32_t object = 0;
};
// Puts light on what was seen: looked[i] for pixels[i]. The frame's planes still hold the packed
// surface, and the cells are filled.
void light_looks(const View& view, const Cells& cells, const Frame& frame,
                 std::span<const uint32_t> pixels, std::span<const Seen> seen,
                 std::vector<LookedPixel>& looked);
// After compose() and accumulate_still(): the more samples of its own a pixel has, the less the
// looks count.
void show_looks(std::span<const uint32_t> pixels, std::span<const LookedPixel> looked,
                const StillImage& still, Frame& frame);

}  // namespace wellspring
