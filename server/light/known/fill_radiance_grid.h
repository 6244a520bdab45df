// SPDX-License-Identifier: Apache-2.0
// Walks that fill a radiance grid (light/sample/radiance_grid.h), once for a scene and its eyes.
#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "light/sample/radiance_grid.h"
#include "light/sample/transport.h"

namespace wellspring {

struct RadianceGridSettings {
  int paths = 400000;  // random walks that fill it
  int max_depth = 9;
  int kept_depth = 5;  // surfaces met later have too little of their walk left to know their light
  uint64_t seed = 1;
  float cell = 0;  // metres; 0: a twenty-fourth of the median free view from the places
};

// Walks start at `places` (scene coordinates: where eyes are likely to be) in all directions; every
// surface they meet learns its light. All cores, a few seconds; the same grid whatever the thread
// count. May be cancelled (base/cancel.h). `parts`: tables of what belongs to no lamp, and of each
// lamp alone, while all are on: every walk learns the light of each of them.
std::shared_ptr<const RadianceGrid> make_radiance_grid(
    const Transport& transport, std::span<const vec3> places,
    const RadianceGridSettings& settings = {},
    std::span<const std::shared_ptr<const LightTables>> parts = {});

}  // namespace wellspring
