// SPDX-License-Identifier: Apache-2.0
// Which sources of a scene emit light while its lamps are switched.
#pragma once
#include <vector>

#include "world/world.h"

namespace wellspring {

// What emits of a scene.
struct EmittingSources {
  std::vector<char> materials, lights;  // of each of the scene's
  bool sky = true;
};
EmittingSources find_emitting(const World& world);  // as its lamps are
// That lamp alone; -1: all that belongs to no lamp.
EmittingSources find_emitting_of(const Scene& scene, int lamp);

}  // namespace wellspring
