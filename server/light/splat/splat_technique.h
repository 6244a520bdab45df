// SPDX-License-Identifier: Apache-2.0
// Technique `multires_splatting`: samples are those of `direct`; of each pass over a picture, the
// samples' places are the pixels on which virtual lights of all sources are splatted, drawn anew
// for each pass. So the mean of many passes becomes direct light and one bounce.
//
// What remains different from `path` with a depth of 3: surfaces reflect the bounce as Lambert does
// on both ends (no highlights, no caustics; rough metal counts as matte); what mirrors show has no
// bounced light; subsplats blur the bounce between discontinuities, its shadows a little more; near
// virtual lights it is bounded, by a radius that shrinks from pass to pass.
#pragma once
#include "light/sample.h"
#include "light/splat/splatter.h"
#include "light/sample/lights.h"

namespace wellspring::light {

// What one pass has drawn.
struct SplatPass {
  SplatLights drawn;
  SplatSettings settings;
  SplatSeed seed;
};

// Functions of the technique between samples (light/technique/technique.h).
void begin_splat(const World& world, const TransportSettings& settings, const View& view,
                 uint64_t seed, uint32_t index, Lights& lights);
void finish_splat(const World& world, const Lights& lights, const View& view,
                  std::span<Sample> samples);

}  // namespace wellspring::light
