// SPDX-License-Identifier: Apache-2.0
// Squares of pixels that are lit as one (Nichols and Wyman 2009, section 3.3): from about 16 x 16
// on, each is parted into four where the pyramid finds a discontinuity, down to single pixels. One
// list serves all virtual lights, as the paper has it for matte surfaces.
#pragma once
#include <cstdint>
#include <span>

#include "light/splat/min_max_pyramid.h"

namespace wellspring::light {

// Column and row among the squares of its level.
struct Subsplat {
  uint16_t x = 0, y = 0;
  uint8_t level = 0;  // of the pyramid: 2^level pixels a side
};
inline constexpr int most_splat_side = 0xffff;  // pixels

// Together they cover every pixel where something is lit, once, and none is without such a pixel.
// Those of one coarsest square follow each other.
struct Subsplats {
  RawVector<Subsplat> list;
  size_t count = 0;  // of `list`; what follows is room
  int coarsest = 0;
  RawVector<uint32_t> first;   // of each coarsest square: workspace
  RawVector<uint8_t> split;    // of each subsplat: to be parted; workspace
  RawVector<Subsplat> parted;  // workspace
  std::span<const Subsplat> all() const { return {list.data(), count}; }
};

// All cores.
void make_subsplats(const SplatPixels& pixels, const MinMaxPyramid& pyramid,
                    const SplatSettings& settings, Subsplats& subsplats);

// Those that `split` marks, none of them a pixel, become those of their four parts where something
// is lit.
void part_subsplats(const SplatPixels& pixels, Subsplats& subsplats);

// The lit pixel that a subsplat is lit by: its middle, or the first of its others where nothing is
// lit in the middle. False: none is.
bool find_lit_pixel(const SplatPixels& pixels, const Subsplat& subsplat, int& x, int& y);

}  // namespace wellspring::light
