// SPDX-License-Identifier: Apache-2.0
// What a curator sees wrong at once when looking, found by rays: somebody stands in a wall, there
// is nothing to see, the scene is tiny or huge, lamps are far too bright.
#pragma once
#include "show/exhibit/exhibit.h"
#include "show/exhibit/problem.h"
#include "world/world.h"

namespace wellspring::show {

// Whether `place` (relative to Scene::origin) lies in something solid: nearly all around there are
// first the backs of surfaces that are no glass. What moves does not count. The name of what the
// nearest of them belongs to goes to `inside`.
bool is_in_solid(const World& world, vec3 place, std::string& inside);

// Whether what stands still is in view. Eyes look through the backs of single-sided faces, so from
// some sides nothing may be there.
bool sees_something(const World& world, const Viewpoint& viewpoint);

// Notes about places, views and size. Milliseconds.
void check_places(const Exhibit& exhibit, const World& world, std::vector<Problem>& problems);

// Notes what visitors see from behind though its material has one side: bakes keep light of fronts
// (light/bake/charts.h). Takes milliseconds.
void check_sides(const Exhibit& exhibit, const World& world, std::vector<Problem>& problems);

// A note where the light that the package carries (light.maps) is of another scene, or damaged.
void check_shipped_light(const Exhibit& exhibit, std::vector<Problem>& problems);

// Notes about lamps and exposure; draws coarse pictures, as exhibit_light.h has it. `world` is of
// exhibit.scene alone.
void check_light(const Exhibit& exhibit, World& world, std::vector<Problem>& problems);

}  // namespace wellspring::show
