// SPDX-License-Identifier: Apache-2.0
// The light of all virtual lights on each subsplat, by eight lights at a time (Nichols and Wyman
// 2009, section 3.4).
#pragma once
#include <cstdint>
#include <span>

#include "light/splat/min_max_pyramid.h"
#include "light/splat/upsample.h"
#include "light/splat/virtual_lights.h"

namespace wellspring::light {

// Squares of pixels that are lit as one (Nichols and Wyman 2009, section 3.3): from about 16 x 16
// on, each is parted into four where the pyramid finds a discontinuity, down to single pixels. One
// list serves all virtual lights, as the paper has it for matte surfaces.

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

// Irradiance at a place with nothing in between. `each`: null, or room for `lights.padded` numbers,
// the luminance of what each light adds.
vec3 sum_virtual_lights(const VirtualLights& lights, vec3 position, vec3 normal,
                        float* each = nullptr);

// Light that a texel can hold: sums may overflow.
inline vec3 bounded_light(vec3 light) {
  constexpr float most = 1e30f;
  auto bounded = [](float v) { return v > 0 ? (v < most ? v : most) : 0.0f; };  // NaN: 0
  return {bounded(light.x), bounded(light.y), bounded(light.z)};
}

// That of one light.
vec3 eval_virtual_light(const VirtualLights& lights, size_t light, vec3 position, vec3 normal);

// Makes `to` empty and as large as the picture of `pyramid`. All cores.
void clear_illumination(const MinMaxPyramid& pyramid, IlluminationPyramid& to);

// Puts each subsplat's irradiance into its texel, without shadows. All cores.
void splat_lights(const SplatPixels& pixels, const VirtualLights& lights,
                  std::span<const Subsplat> subsplats, IlluminationPyramid& to);

// Refinement by convergence, which the paper proposes (section 5): of subsplats whose texels hold
// their light, those become four, level by level, between which and their neighbours linear
// interpolation would miss more than settings.convergence of the light. `to` then holds the light
// of what `subsplats` has become. Returns how many more places were lit.
uint64_t refine_by_convergence(const SplatPixels& pixels, const MinMaxPyramid& pyramid,
                               const VirtualLights& lights, const SplatSettings& settings,
                               Subsplats& subsplats, IlluminationPyramid& to);

}  // namespace wellspring::light
