// SPDX-License-Identifier: Apache-2.0
// What of the virtual lights' light arrives, which the paper leaves out. Each subsplat asks few
// lights, chosen at random by what they would add there, so that its light is right in the mean,
// channel by channel; the share that arrives is then averaged over neighbours that no discontinuity
// parts. Where few rays tell that it changes from one coarse subsplat to the next, these are
// refined first. Those rays do not count for the light itself: a choice by what was measured would
// bias it.
#pragma once
#include "light/sample/transport.h"
#include "light/splat/splat_lights.h"

namespace wellspring::light {

// Workspace, kept from picture to picture.
struct SplatShadowRoom {
  struct Share {
    float red, green, blue;
  };
  RawVector<Share> shares;          // of the light of each subsplat, that arrives
  RawVector<uint32_t> owner;        // subsplat of each square of a level, or none
  std::vector<size_t> first_owner;  // of each level in `owner`
  RawVector<uint32_t> current;      // subsplats of the level that is probed
  RawVector<uint32_t> seen;         // bits: which probe lights each of them sees
  RawVector<float> weight;          // what each probe light would add there
};

// Subsplats above two pixels whose neighbours see other lights become four. Returns the rays cast.
uint64_t refine_by_visibility(const Transport& transport, const SplatPixels& pixels,
                              const MinMaxPyramid& pyramid, const VirtualLights& lights,
                              const SplatSettings& settings, Subsplats& subsplats,
                              SplatShadowRoom& room);

// As splat_lights(), but what does not arrive is left out: settings.shadow_rays for each subsplat
// of four pixels a side and more, a half for those of two, a quarter for single pixels. Same seed:
// same random numbers at the same place of a picture. Returns the rays cast.
uint64_t splat_shadowed_lights(const Transport& transport, const SplatPixels& pixels,
                               const MinMaxPyramid& pyramid, const VirtualLights& lights,
                               const SplatSettings& settings, SplatSeed seed,
                               const Subsplats& subsplats, SplatShadowRoom& room,
                               IlluminationPyramid& to);

}  // namespace wellspring::light
