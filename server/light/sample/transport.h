// SPDX-License-Identifier: Apache-2.0
// What light is carried through: a world, its lights and what is known of both.
#pragma once
#include "base/layers.h"

namespace wellspring::world {
class World;
}

namespace wellspring::light {

struct IlluminationMap;  // light/sample/illumination_map.h
struct LampsSeen;        // light/sample/lamps_seen.h
struct LightTables;      // light/sample/light_tables.h

// Everything a sample needs to know of what stays the same during a call.
struct Transport {
  const World& world;
  const LightTables& tables;
  const IlluminationMap* known = nullptr;  // on which walks end, where a technique may use it
  const LampsSeen* lamps = nullptr;        // what weighs the choice among few lamps, where known
  const IlluminationMap* maps = nullptr;   // by which samples tell the diffuse light they find
};

}  // namespace wellspring::light
