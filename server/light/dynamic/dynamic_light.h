// SPDX-License-Identifier: Apache-2.0
// Lights that move or change while an exhibit runs: a torch that is carried, a fire that flickers,
// the sun over a day. They are no part of Lights: nothing that is kept or baked knows them. Light
// adds up, so theirs is computed for each picture and added to that of what stands still.
#pragma once
#include <cstdint>
#include <vector>

#include "world/emitter.h"

namespace wellspring::light {

struct DynamicLight {
  PunctualLight light;  // as it is at the moment, relative to Scene::origin
  uint32_t id = 0;      // the same from picture to picture, of no other
  float radius = 0;     // metres around it in which nothing casts a shadow: its flame does not
};

// Those that a visitor sees by, black ones left out.
using DynamicLights = std::vector<DynamicLight>;

}  // namespace wellspring::light
