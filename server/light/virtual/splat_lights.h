// SPDX-License-Identifier: Apache-2.0
// Adds up the light of all virtual lights on each subsplat, by eight lights at a time (Nichols and
// Wyman 2009, section 3.4).
#pragma once
#include <cstdint>
#include <span>

#include "light/virtual/min_max_pyramid.h"
#include "light/virtual/upsample.h"
#include "light/virtual/virtual_lights.h"

namespace wellspring::light {

// Finds squares of pixels that are lit as one (Nichols and Wyman 2009, section 3.3): from about 16
// x 16 on, each is parted into four where the pyramid finds a discontinuity, down to single pixels.
// One list serves all virtual lights, as the paper has it for matte surfaces.

// A subsplat is a column and a row among the squares of its level.
struct Subsplat {
  uint16_t x = 0, y = 0;
  uint8_t level = 0;  // level of the pyramid: 2^level pixels a side
};
inline constexpr int most_splat_side = 0xffff;  // pixels

// Holds subsplats that together cover every pixel where something is lit, once; none is without
// such a pixel. Subsplats of one coarsest square follow each other.
struct Subsplats {
  RawVector<Subsplat> list;
  size_t count = 0;  // used part of `list`; the remainder is room
  int coarsest = 0;
  RawVector<uint32_t> first;   // index of each coarsest square's first: workspace
  RawVector<uint8_t> split;    // 1 for each subsplat to be parted; workspace
  RawVector<Subsplat> parted;  // workspace
  std::span<const Subsplat> all() const { return {list.data(), count}; }
};

// Makes the list on all cores.
void make_subsplats(const SplatPixels& pixels, const MinMaxPyramid& pyramid,
                    const SplatSettings& settings, Subsplats& subsplats);

// Replaces the subsplats that `split` marks, none of them a pixel, by those of their four parts
// that have something lit.
void part_subsplats(const SplatPixels& pixels, Subsplats& subsplats);

// Finds the lit pixel that a subsplat is lit by: its middle, or its first lit one if nothing is lit
// in the middle. Returns false if there is none.
bool find_lit_pixel(const SplatPixels& pixels, const Subsplat& subsplat, int& x, int& y);

// Returns the irradiance at a place with nothing in between. `each`: null, or room for
// `lights.padded` numbers, the luminance of what each light adds.
vec3 sum_virtual_lights(const VirtualLights& lights, vec3 position, vec3 normal,
                        float* each = nullptr);

// Returns light that a texel can hold: sums may overflow.
inline vec3 bounded_light(vec3 light) {
  constexpr float most = 1e30f;
  auto bounded = [](float v) { return v > 0 ? (v < most ? v : most) : 0.0f; };  // NaN: 0
  return {bounded(light.x), bounded(light.y), bounded(light.z)};
}

// Returns the irradiance by one light.
vec3 eval_virtual_light(const VirtualLights& lights, size_t light, vec3 position, vec3 normal);

// Makes `to` empty and as large as the picture of `pyramid`. Runs on all cores.
void clear_illumination(const MinMaxPyramid& pyramid, IlluminationPyramid& to);

// Puts each subsplat's irradiance into its texel, without shadows. Runs on all cores.
void splat_lights(const SplatPixels& pixels, const VirtualLights& lights,
                  std::span<const Subsplat> subsplats, IlluminationPyramid& to);

// Refines by convergence, which the paper proposes (section 5): of subsplats whose texels hold
// their light, those become four, level by level, between which and their neighbours linear
// interpolation would miss more than settings.convergence of the light. `to` then holds the light
// of the refined `subsplats`. Returns how many more places were lit.
uint64_t refine_by_convergence(const SplatPixels& pixels, const MinMaxPyramid& pyramid,
                               const VirtualLights& lights, const SplatSettings& settings,
                               Subsplats& subsplats, IlluminationPyramid& to);

}  // namespace wellspring::light
