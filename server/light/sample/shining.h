// SPDX-License-Identifier: Apache-2.0
// Which sources of a scene shine while its lamps are switched.
#pragma once
#include <vector>

#include "world/world.h"

namespace wellspring {

// What shines of a scene.
struct Shining {
  std::vector<char> materials, lights;  // of each of the scene's
  bool sky = true;
};
Shining what_shines(const World& world);  // as its lamps are
// That lamp alone; -1: all that belongs to no lamp.
Shining what_shines_of(const Scene& scene, int lamp);

}  // namespace wellspring
