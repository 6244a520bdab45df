// SPDX-License-Identifier: Apache-2.0
// Where the solids of a scene are (light/sample/medium.h).
#pragma once
#include <cstdint>
#include <vector>

#include "light/transport_plan.h"
#include "world/world.h"

namespace wellspring::light {

// Boxes of the solids that stand still, for places that ask whether they are in one.
struct SolidBounds {
  Bounds all;
  std::vector<Bounds> each;
  uint64_t key = 0;  // no other has it
};
Bounds bounds_of(const PlacedMesh& placed);  // scene coordinates
SolidBounds find_solid_bounds(const World& world, const TransportPlan& plan);

}  // namespace wellspring::light
