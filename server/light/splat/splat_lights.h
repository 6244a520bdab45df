// SPDX-License-Identifier: Apache-2.0
// The light of all virtual lights on each subsplat, by eight lights at a time (Nichols and Wyman
// 2009, section 3.4).
#pragma once
#include <span>

#include "light/splat/illumination_pyramid.h"
#include "light/splat/subsplats.h"
#include "light/splat/virtual_lights.h"

namespace wellspring::light {

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
