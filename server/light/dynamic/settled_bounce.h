// SPDX-License-Identifier: Apache-2.0
// Light scattered once of those dynamic lights that stay as they are for a while, as the sun at the
// hour that was chosen: the mean of many passes of virtual lights, of other random numbers each and
// with their shadows, so that a picture at rest comes to the true light of one bounce.
#pragma once
#include <vector>

#include "light/dynamic/dynamic_image.h"

namespace wellspring::light {

struct SettledBounce {
  struct Unchanged {
    DynamicLight light;
    int pictures = 0;  // for how many it has been as it is
  };
  std::vector<Unchanged> last;  // all lights of the last picture
  DynamicLights lights;         // those of them that count as settled
  int pictures = 0;             // since they are these lights
  int passes = 0;               // in the mean
  LightPlanes mean;             // of what they scatter
};
size_t memory_bytes(const SettledBounce& settled);

// Once a picture: moves those of `from` that have settled to settled.lights, leaves the others.
void take_settled(SettledBounce& settled, DynamicLights& from);

// One of `between_passes` pictures has a pass, so that pictures keep their rate; after
// `most_passes` one of `between_late` has, for things that were moved.
inline constexpr int most_passes = 64, between_passes = 3, between_late = 32;
bool wants_pass(const SettledBounce& settled);
// Adds one to the mean. The first, by `settings`, is that of lights that have not settled, and
// counts as much as `first_weight` of the others, so that from it on the picture changes smoothly.
// Overwrites `bounce`. All cores; as light_surfaces().
inline constexpr int first_weight = 8;
void add_pass(const World& world, const Lights& lights, const SurfaceBuffer& surfaces,
              const SplatSettings& settings, SettledBounce& settled, DynamicBounce& bounce);
// Adds the mean.
void add_settled(const SettledBounce& settled, LightPlanes& light);

}  // namespace wellspring::light
