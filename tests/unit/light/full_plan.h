// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "light/transport_plan.h"

namespace wellspring::test {

// Everything on, as far as the scene's materials can be asked for it: proves that what a plan left
// out does not matter.
inline TransportPlan make_full_plan(const Scene& scene) {
  TransportPlan plan;
  for (TransportDecision& decision : plan.decisions) decision = {true, "asked for"};
  for (const Material& m : scene.materials) {
    bool through = m.transmission > 0, solid = m.thickness > 0;
    plan.materials.push_back({true, true, true, true, true, through && !solid, through && solid,
                              true, true, true, true});
  }
  return plan;
}

}  // namespace wellspring::test
