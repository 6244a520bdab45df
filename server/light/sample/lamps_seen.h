// SPDX-License-Identifier: Apache-2.0
// Learns which of few lamps the places of a scene see: in rooms most shadow rays towards the sun
// end at a wall, and a lamp that is drawn for its unshadowed effect alone is drawn in vain. Shares
// of each lamp's light that arrive, learned by shadow rays from random places before the first
// sample, weigh the choice among the lamps (Vevoda, Kondapaneni, Krivanek 2018, "Bayesian online
// regression for adaptive direct illumination sampling", learned beforehand, so that a sample
// remains a function of its ray and seed). Every lamp keeps a chance wherever it might emit light,
// so nothing is biased, whatever moves into the light later.
#pragma once
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "light/sample/light_tables.h"

namespace wellspring::light {

struct Transport;

struct LampsSeen {
  using Shares =
      // Shares in 255ths, at least 1; by LightTables::punctual_index
      std::array<uint8_t, FewLights::most>;
  float cell = 0.5f;  // side of a cell, metres
  // place_key, at the slot that find_place_slot() returns; 0: free
  std::vector<uint64_t> keys;
  std::vector<Shares> shares;
};

struct LampsSeenSettings {
  int walks = 1 << 16;
  float cell = 0;  // metres; 0: a twelfth of the median free view from the places
  uint64_t seed = 1;
};

// Learns for eyes near `places` (scene coordinates). Returns null if the scene's lamps are one,
// none or too many. Takes less than a second on all cores; the result is the same whatever the
// thread count.
std::shared_ptr<const LampsSeen> learn_lamps_seen(const Transport& transport,
                                                  std::span<const vec3> places,
                                                  const LampsSeenSettings& settings = {});

// Returns the lamps' shares at a place, or null if no walk came there. `normal`: the geometric one,
// on the side that is looked at.
const LampsSeen::Shares* find_lamps_seen(const LampsSeen& seen, vec3 position, vec3 normal);

}  // namespace wellspring::light
