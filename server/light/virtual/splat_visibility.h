// SPDX-License-Identifier: Apache-2.0
// Computes shadows of the VPLs, which the paper leaves out. Each subsplat casts rays to
// few lights, chosen at random by what they would add there, so that its light is right in the
// mean, channel by channel; the share that arrives is then averaged over neighbours that no
// discontinuity parts. If few rays show that it changes from one coarse subsplat to the next, these
// are refined first. Those rays do not count for the light itself: a choice by what was measured
// would bias it.
#pragma once
#include <span>

#include "light/sample/sample_light.h"
#include "light/sample/transport.h"
#include "light/virtual/splat_lights.h"
#include "light/virtual/virtual_lights.h"
#include "world/world.h"

namespace wellspring::light {

// Collects shadow rays from what pixels see to VPLs until a packet is full.

// Returns where rays leave a pixel's surface. Its normal may be a shading normal, and its depth be
// rounded. `apart`: World::any_apart().
vec3 shadow_origin(vec3 place, vec3 normal, float depth, bool apart = false);

// Collects rays; the light that arrives along one goes to the item that it was added for.
class ShadowPacket {
 public:
  explicit ShadowPacket(const Transport& transport) : transport_(transport) {}
  bool full() const { return count_ == RayPacket::lanes; }
  void add(vec3 from, vec3 target, uint32_t item);
  // Calls arrive(item, tint) for every ray that is not blocked, in the order of add(), and is empty
  // afterwards.
  template <class Arrive>
  void cast(const Arrive& arrive) {
    if (count_ == 0) return;
    uint32_t blocked = find_blocked();
    for (int i = 0; i < count_; i++) {
      vec3 tint = blocked >> i & 1 ? eval_blocked(transport_, rays_, i) : vec3(1);
      if (max_component(tint) > 0) arrive(item_[i], tint);
    }
    count_ = 0;
  }

 private:
  uint32_t find_blocked() const;
  const Transport& transport_;
  RayPacket rays_;
  uint32_t item_[RayPacket::lanes];
  int count_ = 0;
};

// Holds workspace, kept from picture to picture.
struct SplatShadowRoom {
  struct Share {
    float red, green, blue;
  };
  RawVector<Share> shares;          // share of each subsplat's light that arrives
  RawVector<uint32_t> owner;        // subsplat of each square of a level, or none
  std::vector<size_t> first_owner;  // index of each level's first in `owner`
  RawVector<uint32_t> current;      // subsplats of the level that is probed
  RawVector<uint32_t> seen;         // bits: the probe lights each of them sees
  RawVector<float> weight;          // luminance each probe light would add there
};

// Parts subsplats above two pixels whose neighbours see other lights into four. Returns the rays
// cast.
uint64_t refine_by_visibility(const Transport& transport, const SplatPixels& pixels,
                              const MinMaxPyramid& pyramid, const VirtualLights& lights,
                              const SplatSettings& settings, Subsplats& subsplats,
                              SplatShadowRoom& room);

// Works as splat_lights(), but leaves out light that does not arrive: casts settings.shadow_rays
// for each subsplat of four pixels a side and more, a half for those of two, a quarter for single
// pixels. The same seed gives the same random numbers at the same place of a picture. Returns the
// rays cast.
uint64_t splat_shadowed_lights(const Transport& transport, const SplatPixels& pixels,
                               const MinMaxPyramid& pyramid, const VirtualLights& lights,
                               const SplatSettings& settings, SplatSeed seed,
                               const Subsplats& subsplats, SplatShadowRoom& room,
                               IlluminationPyramid& to);

// Computes shadows of VPLs for the price of few rays, if each place cannot have its own:
// the mean share of a light that arrives at visible places is taken for all places. So light does
// not pass through walls, and a picture's light is right in the mean; the light of places half in
// shadow is not.

// Holds a place that is visible.
struct LitProbe {
  vec3 position{0}, normal{0, 1, 0};
  float depth = 0;  // from the eye: tells how exact the place is
};

// Dims each light by the share of its light that arrives at `probes`, by at most `rays` rays a
// light, to probes that would have most of it. Lights that reach no probe are left out. Runs on all
// cores.
void dim_hidden_lights(const Transport& transport, std::span<const LitProbe> probes, int rays,
                       VirtualLights& lights);

}  // namespace wellspring::light
