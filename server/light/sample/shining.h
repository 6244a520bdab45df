// SPDX-License-Identifier: Apache-2.0
// How brightly the sources of a scene emit light while its lamps are switched or dimmed.
#pragma once
#include <vector>

#include "world/world.h"

namespace wellspring::light {

// How brightly it does, times the scene's own light: 0 to 1.
struct EmittingSources {
  std::vector<float> materials, lights;  // of each of the scene's
  bool sky = true;
};
EmittingSources find_emitting(const World& world);  // as its lamps are
// That lamp alone; -1: all that belongs to no lamp.
EmittingSources find_emitting_of(const Scene& scene, int lamp);

}  // namespace wellspring::light
