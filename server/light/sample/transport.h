// SPDX-License-Identifier: Apache-2.0
// Holds what light is carried through: a world, its lights and the light that is kept of both.
#pragma once
#include "base/layers.h"

namespace wellspring::world {
class World;
}

namespace wellspring::light {

struct IlluminationMap;  // light/sample/illumination_map.h
struct LampsSeen;        // light/sample/lamps_seen.h
struct LightTables;      // light/sample/light_tables.h

// Holds everything a sample needs that stays the same during a call.
struct Transport {
  const World& world;
  const LightTables& tables;
  const IlluminationMap* known = nullptr;  // light on which walks end, if a technique may use it
  // Shares that weigh the choice among few lamps, if learned
  const LampsSeen* lamps = nullptr;
  // Light in whose multiples samples give the diffuse light that they find
  const IlluminationMap* maps = nullptr;
  // The eye's own rays meet World::volumes(); those of walks always do.
  bool sees_volumes = false;
};

}  // namespace wellspring::light
